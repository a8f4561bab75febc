// Refine: brings the present placement near balance with as few moves as possible.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Moves one element at a time from the slowest PE to the PE for which the later of the two
/// finishes first, until max/average is at most `tolerance` or no move helps the slowest PE. Never
/// makes the slowest PE slower. O(log n) per move, plus the PEs that are tried without success.
[[nodiscard]] Assignment refine(const Snapshot& snapshot, double tolerance = 1.03);

/// The same, starting from a permitted placement that another strategy proposes.
[[nodiscard]] Assignment refine_from(const Snapshot& snapshot, Assignment start, double tolerance);

}  // namespace tess::balance
