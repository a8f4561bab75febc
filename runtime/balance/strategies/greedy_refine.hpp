// Greedy's balance with few moves: only the excess of overloaded PEs is moved.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Every PE above the average gives up elements that make up its excess, largest first. These go,
/// heaviest first, to the PE that finishes first; a refinement follows. If the slowest PE is then
/// still above `tolerance` times greedy's, the result is greedy's.
[[nodiscard]] Assignment greedy_refine(const Snapshot& snapshot, double tolerance = 1.02);

}  // namespace tess::balance
