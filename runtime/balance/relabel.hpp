// Which PE gets which part: a partitioner numbers its parts as it likes, and PEs that are alike can
// change parts for nothing. Without it a partition that hardly differs from the present placement
// would move nearly every element.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// `wanted` with its parts renumbered among PEs of equal speed, background and memory limit that
/// hold no pinned elements, largest packed overlap with the present placement first.
[[nodiscard]] Assignment relabel(const Snapshot& snapshot, Assignment wanted);

}  // namespace tess::balance
