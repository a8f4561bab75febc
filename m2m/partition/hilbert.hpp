// Positions on a Hilbert curve through a cube of 2^21 cells per side (Hamilton 2006, "Compact
// Hilbert indices", section 2). Neighbours on the curve share a face. A position at a lower level
// is the prefix of the position at a higher one: three bits per level.
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>

namespace tess::m2m {

inline constexpr int hilbert_levels = 21;

/// Cells of a cube around a box.
class HilbertCube {
 public:
  HilbertCube() = default;
  explicit HilbertCube(const Aabb& box);
  /// The interleaved bits of a point's cell, with the first axis highest. A point outside has the
  /// nearest cell.
  [[nodiscard]] std::uint64_t cell(const Point& p) const;

 private:
  Point low_{};
  double cells_per_length_ = 0;
};

/// The position on the curve of level `levels`, from 0 to 8^levels - 1, of a cell().
[[nodiscard]] std::uint64_t hilbert_position(std::uint64_t cell, int levels);

}  // namespace tess::m2m
