// Recursive coordinate bisection (Berger and Bokhari 1987): parts are boxes, so that neighbours in
// space share a PE.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Cuts the PEs in two halves, the elements along their longest extent in proportion to what the
/// halves can do, and so on. Throws Error where the snapshot has no positions.
/// O(n log n log n_pes).
[[nodiscard]] Assignment rcb(const Snapshot& snapshot);

}  // namespace tess::balance
