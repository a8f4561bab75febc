// A Hilbert curve through the positions, cut into one piece per PE. It is cheaper than rcb, and a
// small change of loads moves few elements.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Throws Error if the snapshot has no positions. O(n log n).
[[nodiscard]] Assignment hilbert(const Snapshot& snapshot);

}  // namespace tess::balance
