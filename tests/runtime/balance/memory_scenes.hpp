// Snapshots whose elements share blocks, and their memory by its definition: the oracle for
// runtime/balance/memory.hpp and for every strategy.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Any valid snapshot with shared blocks, working memory and limits, some of them broken already.
[[nodiscard]] Snapshot any_memory(std::uint64_t seed);

/// The memory of each PE, computed anew from sets of blocks.
[[nodiscard]] std::vector<std::uint64_t> memory_by_definition(const Snapshot& snapshot,
                                                              const Assignment& assignment);

/// True if no PE is above its limit that was not, and none of the others is fuller than before.
[[nodiscard]] bool keeps_limits(const Snapshot& snapshot, const Assignment& assignment);

}  // namespace tess::balance
