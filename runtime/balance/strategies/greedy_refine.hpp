// Greedy's balance with few moves: only what is too much on its PE goes.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Every PE above the average sheds elements that make up its excess, largest first; these go,
/// heaviest first, to the PE that is done soonest; a refinement follows. Where the slowest PE is
/// then still above `tolerance` times greedy's, the answer is greedy's.
[[nodiscard]] Assignment greedy_refine(const Snapshot& snapshot, double tolerance = 1.02);

}  // namespace tess::balance
