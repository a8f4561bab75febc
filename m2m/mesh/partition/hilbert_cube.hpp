// Cells of a cube around a box: the cells of a Hilbert curve with 2^21 of them per side.
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>

namespace tess::m2m {

inline constexpr int hilbert_levels = 21;

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

}  // namespace tess::m2m
