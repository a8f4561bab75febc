// Two levels: groups of PEs share few elements, PEs of a group share all of theirs. No step looks
// at all elements on all PEs at once, so that groups can decide side by side.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// PEs in consecutive groups of `group_size` (0: about the square root of their number). Elements
/// go between groups by refine, to the PE of the group that is done soonest; then greedy within
/// every group.
[[nodiscard]] Assignment hierarchical(const Snapshot& snapshot, std::size_t group_size = 0);

}  // namespace tess::balance
