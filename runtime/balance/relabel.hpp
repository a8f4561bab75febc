// Assigns parts to PEs. A partitioner numbers its parts arbitrarily, and equal PEs can exchange
// parts for free. Without relabelling, a partition that hardly differs from the present placement
// would move nearly every element.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// `wanted` with its parts renumbered among PEs of equal speed and memory, and of nearly equal
/// background (within 2 % of the average time), without
/// pinned elements, such that the packed overlap with the present placement is large (greedily,
/// largest overlap first).
[[nodiscard]] Assignment relabel(const Snapshot& snapshot, Assignment wanted);

}  // namespace tess::balance
