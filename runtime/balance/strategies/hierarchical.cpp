// Two levels: groups of PEs exchange few elements, and the PEs of a group exchange all of theirs.
// No step uses all elements on all PEs, so groups can decide in parallel.
#include "runtime/balance/loads.hpp"
#include "runtime/balance/strategies/greedy.hpp"
#include "runtime/balance/strategies/refine.hpp"

#include <algorithm>
#include <cmath>

namespace tess::balance {
namespace {

/// A snapshot in which each group is one PE, as fast as its PEs together.
Snapshot of_groups(const Snapshot& s, std::size_t group_size) {
  Snapshot groups;
  groups.elements = s.elements;
  groups.blocks = s.blocks;
  for (PeId& pe : groups.elements.pe) pe = pe_at(slot(pe) / group_size);
  const std::size_t n_groups = (s.pes.size() + group_size - 1) / group_size;
  groups.pes.background.assign(n_groups, 0.0);
  groups.pes.speed.assign(n_groups, 0.0);
  groups.pes.memory_limit_bytes.assign(n_groups, 0);
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    groups.pes.background[p / group_size] += s.pes.background[p] * s.pes.speed[p];
    groups.pes.speed[p / group_size] += s.pes.speed[p];
  }
  for (std::size_t g = 0; g < n_groups; ++g) groups.pes.background[g] /= groups.pes.speed[g];
  return groups;
}

/// Places every element whose group changes on the PE of its new group that finishes first.
Assignment enter(const Snapshot& s, const Assignment& group, std::size_t group_size) {
  Assignment result = s.elements.pe;
  Loads loads = Loads::present(s);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::size_t from = slot(result[i]);
    if (slot(group[i]) == from / group_size) continue;
    const std::size_t begin = slot(group[i]) * group_size;
    std::size_t best = from;
    for (std::size_t p = begin; p < std::min(begin + group_size, s.pes.size()); ++p)
      if (loads.fits(i, from, p) && (best == from || loads.time(p) < loads.time(best))) best = p;
    loads.move(i, from, best);
    result[i] = pe_at(best);
  }
  return result;
}

/// The snapshot of one group: its PEs, numbered from 0, and the elements on them.
Snapshot inside(const Snapshot& s, const Assignment& placed,
                const std::vector<std::size_t>& elements, std::size_t begin, std::size_t end) {
  Snapshot group;
  group.blocks = s.blocks;
  for (std::size_t p = begin; p < end; ++p) {
    group.pes.background.push_back(s.pes.background[p]);
    group.pes.speed.push_back(s.pes.speed[p]);
    group.pes.memory_limit_bytes.push_back(s.pes.memory_limit_bytes[p]);
    group.pes.working_bytes.push_back(s.pes.working_bytes_of(p));
  }
  for (const std::size_t i : elements) {
    group.elements.key.push_back(s.elements.key[i]);
    group.elements.pe.push_back(pe_at(slot(placed[i]) - begin));
    group.elements.load.push_back(s.elements.load[i]);
    group.elements.migratable.push_back(s.elements.migratable[i]);
    group.elements.size_bytes.push_back(s.elements.size_bytes[i]);
    group.elements.memory_bytes.push_back(s.elements.memory_bytes[i]);
    group.elements.working_bytes.push_back(s.elements.working_bytes_of(i));
    group.elements.block.push_back(s.elements.block_of(i));
  }
  return group;
}

}  // namespace

/// PEs form consecutive groups, of about the square root of their number. Elements move between
/// groups by refine, to the PE of the group that finishes first; then greedy runs within every
/// group. With memory limits the result can be worse than the present placement.
Assignment hierarchical(const Snapshot& s) {
  const auto group_size =
      static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(s.pes.size()))));
  const Snapshot groups = of_groups(s, group_size);
  Assignment result = enter(s, refine(groups, 1.01), group_size);
  std::vector<std::vector<std::size_t>> members(groups.pes.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    members[slot(result[i]) / group_size].push_back(i);
  for (std::size_t g = 0; g < members.size(); ++g) {
    const std::size_t begin = g * group_size;
    const std::size_t end = std::min(begin + group_size, s.pes.size());
    const Assignment placed = greedy(inside(s, result, members[g], begin, end));
    for (std::size_t k = 0; k < placed.size(); ++k)
      result[members[g][k]] = pe_at(begin + slot(placed[k]));
  }
  return result;
}

}  // namespace tess::balance
