#include "runtime/balance/relabel.hpp"

#include "runtime/balance/metrics.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace tess::balance {
namespace {

/// PEs whose background differs by less than this part of the average time can exchange their
/// parts: where it is measured, no two are equal.
constexpr double same_background = 0.02;

/// Equal numbers for PEs that can exchange their parts.
std::vector<std::size_t> kinds(const Snapshot& s) {
  std::vector<std::size_t> alone(s.pes.size(), 0);  // above 0: different from all others
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (!s.elements.migratable[i]) alone[slot(s.elements.pe[i])] = 1 + slot(s.elements.pe[i]);
  const auto needs = [&](std::size_t p) {
    return std::tuple(s.pes.speed[p], s.pes.memory_limit_bytes[p], s.pes.working_bytes_of(p),
                      alone[p]);
  };
  std::vector<std::size_t> order(s.pes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t p) {
    return std::tuple_cat(needs(p), std::tuple(s.pes.background[p], p));
  });
  const double near = same_background * average_time(s);
  std::vector<std::size_t> result(s.pes.size());
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    const std::size_t p = order[i], of = order[first];
    if (needs(p) != needs(of) || s.pes.background[p] - s.pes.background[of] > near) first = i;
    result[p] = order[first];
  }
  return result;
}

struct Overlap {
  std::uint64_t bytes = 0;
  std::size_t part = 0;
  std::size_t pe = 0;
};

/// The overlap of each part with each PE of its kind, largest first.
std::vector<Overlap> overlaps(const Snapshot& s, const Assignment& wanted,
                              const std::vector<std::size_t>& kind) {
  std::map<std::pair<std::size_t, std::size_t>, std::uint64_t> bytes;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::size_t part = slot(wanted[i]), pe = slot(s.elements.pe[i]);
    if (kind[part] == kind[pe]) bytes[{part, pe}] += s.elements.size_bytes[i] + 1;
  }
  std::vector<Overlap> result;
  for (const auto& [part_on_pe, n_bytes] : bytes)
    result.push_back({n_bytes, part_on_pe.first, part_on_pe.second});
  std::ranges::stable_sort(result, std::greater{}, &Overlap::bytes);
  return result;
}

}  // namespace

Assignment relabel(const Snapshot& s, Assignment wanted) {
  const std::vector<std::size_t> kind = kinds(s);
  const std::size_t none = s.pes.size();
  std::vector<std::size_t> pe_of(s.pes.size(), none);
  std::vector<bool> taken(s.pes.size(), false);
  for (const Overlap& overlap : overlaps(s, wanted, kind)) {
    if (pe_of[overlap.part] != none || taken[overlap.pe]) continue;
    pe_of[overlap.part] = overlap.pe;
    taken[overlap.pe] = true;
  }
  std::map<std::size_t, std::vector<std::size_t>> left;  // PEs by kind, highest first
  for (std::size_t p = s.pes.size(); p-- > 0;)
    if (!taken[p]) left[kind[p]].push_back(p);
  for (std::size_t part = 0; part < s.pes.size(); ++part) {
    if (pe_of[part] != none) continue;
    pe_of[part] = left[kind[part]].back();
    left[kind[part]].pop_back();
  }
  for (PeId& pe : wanted) pe = pe_at(pe_of[slot(pe)]);
  return wanted;
}

}  // namespace tess::balance
