// Positions on Hilbert curves. A curve visits every cell of a square or a cube of 2^levels cells
// per side, and each step is to a neighbour. A position at a lower level is the prefix of the
// position at a higher one. All curves are walked by one table per curve, a step per level.
//
// In space there are two curves, because partitions and assignments must not change: that of a cube
// (Hamilton 2006, "Compact Hilbert indices", section 2), and the one that also has a form in the
// plane (Skilling 2004, "Programming the Hilbert curve").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tess {

/// The position on Hamilton's curve, from 0 to 8^levels - 1. `cell` has three bits per level, the
/// highest level and the first axis first.
[[nodiscard]] std::uint64_t hilbert_position(std::uint64_t cell, int levels);

/// The position on Skilling's curve of a cell of a grid with 2^levels cells per axis, for up to
/// three axes; n_axes × levels must be at most 64.
[[nodiscard]] std::uint64_t hilbert_key(const std::array<std::uint32_t, 3>& cell,
                                        std::size_t n_axes, unsigned levels);

}  // namespace tess
