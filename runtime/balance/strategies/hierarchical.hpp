// Two levels: groups of PEs exchange few elements, and the PEs of a group exchange all of theirs.
// No step uses all elements on all PEs, so groups can decide in parallel.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// PEs form consecutive groups of `group_size` (0: about the square root of their number). Elements
/// move between groups by refine, to the PE of the group that finishes first; then greedy runs
/// within every group. With memory limits the result can be worse than the present placement.
[[nodiscard]] Assignment hierarchical(const Snapshot& snapshot, std::size_t group_size = 0);

}  // namespace tess::balance
