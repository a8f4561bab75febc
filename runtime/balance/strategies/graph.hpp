// Balances load and communication together: elements are vertices, messages are edges, PEs are the
// parts; by Scotch (Pellegrini and Roman 1996; sequential, in the caller's thread, without MPI).
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Minimises the bytes between PEs within `tolerance` of balance: a mapping onto PEs weighted by
/// their capacity, with pinned elements as fixed vertices, then a refinement if whole elements left
/// a PE above the tolerance. If no two elements communicate: greedy_refine.
[[nodiscard]] Assignment graph(const Snapshot& snapshot, std::uint64_t seed,
                               double tolerance = 1.05);

/// False where Tessera is built without Scotch: then graph() throws Error.
[[nodiscard]] bool graph_is_built();

}  // namespace tess::balance
