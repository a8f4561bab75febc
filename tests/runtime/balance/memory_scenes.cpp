#include "tests/runtime/balance/memory_scenes.hpp"

#include "apps/bench/balance_scenes.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <set>

namespace tess::balance {

Snapshot any_memory(std::uint64_t seed) {
  Snapshot s = anything(seed);
  Random next(seed + 77);
  for (std::size_t k = next.below(7); k > 0; --k)
    s.blocks.push_back({10 * k + next.below(10), next.below(400), pe_at(next.below(s.pes.size()))});
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    s.elements.working_bytes.push_back(next.below(3) == 0 ? 0 : next.below(60));
    s.elements.block.push_back(
        s.blocks.empty() || next.below(4) == 0 ? no_block : next.below(s.blocks.size()));
  }
  for (std::size_t p = 0; p < s.pes.size(); ++p) s.pes.working_bytes.push_back(next.below(30));
  const std::vector<std::uint64_t> used = memory_by_definition(s, s.elements.pe);
  for (std::size_t p = 0; p < s.pes.size(); ++p)
    s.pes.memory_limit_bytes[p] = next.below(4) == 0 ? 0 : used[p] * 3 / 4 + 1 + next.below(700);
  return s;
}

std::vector<std::uint64_t> memory_by_definition(const Snapshot& s, const Assignment& a) {
  std::vector<std::uint64_t> result;
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    std::uint64_t bytes = s.pes.working_bytes_of(p), most_work = 0;
    std::set<std::size_t> blocks;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (slot(a[i]) != p) continue;
      bytes += s.elements.memory_bytes[i];
      most_work = std::max(most_work, s.elements.working_bytes_of(i));
      if (s.elements.block_of(i) != no_block) blocks.insert(s.elements.block_of(i));
    }
    for (const std::size_t block : blocks) bytes += s.blocks[block].bytes;
    result.push_back(bytes + most_work);
  }
  return result;
}

bool keeps_limits(const Snapshot& s, const Assignment& a) {
  const std::vector<std::uint64_t> before = memory_by_definition(s, s.elements.pe);
  const std::vector<std::uint64_t> after = memory_by_definition(s, a);
  for (std::size_t p = 0; p < s.pes.size(); ++p)
    if (s.pes.memory_limit_bytes[p] != 0 &&
        after[p] > std::max(before[p], s.pes.memory_limit_bytes[p]))
      return false;
  return true;
}

}  // namespace tess::balance
