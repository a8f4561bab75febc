// Load and communication together: elements are vertices, messages edges, PEs the parts, by Scotch
// (Pellegrini and Roman 1996; sequential, in the caller's thread, without MPI).
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Few bytes between PEs within `tolerance` of balance: a mapping onto PEs as wide as they are
/// fast, with pinned elements as fixed vertices, then a refinement where whole elements left a PE
/// above the tolerance. Where no two elements talk: greedy_refine.
[[nodiscard]] Assignment graph(const Snapshot& snapshot, std::uint64_t seed,
                               double tolerance = 1.05);

}  // namespace tess::balance
