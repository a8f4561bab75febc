// Recursive coordinate bisection (Berger and Bokhari 1987): parts are boxes, so that neighbours in
// space share a PE.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Divides the PEs into two halves, and the elements along their longest extent in proportion to
/// the capacities of the halves, and so on recursively. Throws Error if the snapshot has no
/// positions. O(n log n log n_pes).
[[nodiscard]] Assignment rcb(const Snapshot& snapshot);

}  // namespace tess::balance
