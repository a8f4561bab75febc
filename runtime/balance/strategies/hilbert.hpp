// A Hilbert curve through the positions, cut into one piece per PE. It is cheaper than rcb, and a
// small change of loads moves few elements.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Throws Error if the snapshot has no positions. O(n log n).
[[nodiscard]] Assignment hilbert(const Snapshot& snapshot);

/// The place along the curve of a point of a grid with 2^bits cells per axis; n_axes × bits must be
/// at most 64. (Skilling 2004, "Programming the Hilbert curve".)
[[nodiscard]] std::uint64_t hilbert_key(std::array<std::uint32_t, 3> cell, std::size_t n_axes,
                                        unsigned bits);

}  // namespace tess::balance
