// Refine: the present placement, with as few moves as bring it near balance.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Moves from the slowest PE, one element at a time, to the PE that leaves the later of the two
/// soonest done, until max/average is at most `tolerance` or the slowest PE cannot be helped.
/// Never makes the slowest PE slower. O(log n) a move, plus the PEs that are tried in vain.
[[nodiscard]] Assignment refine(const Snapshot& snapshot, double tolerance = 1.03);

/// The same, starting from a placement that some other strategy proposes (and that may be).
[[nodiscard]] Assignment refine_from(const Snapshot& snapshot, Assignment start, double tolerance);

}  // namespace tess::balance
