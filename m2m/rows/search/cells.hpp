// A grid of cells over the box of some points, for sorting: it is coarse enough that the cells are
// about as many as asked, whatever the shape of the box. A point outside is in the nearest cell.
#pragma once

#include "m2m/mesh.hpp"
#include "runtime/core/algorithm.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tess::m2m {

class Cells {
 public:
  /// A single cell.
  Cells() = default;
  /// About `n_wanted` cells, at most 8 times as many.
  Cells(const Aabb& box, std::size_t n_wanted);

  [[nodiscard]] std::size_t n_cells() const {
    return static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
           static_cast<std::size_t>(size_[2]);
  }
  /// The cell of a coordinate along an axis. It does not decrease with x.
  [[nodiscard]] std::int32_t along(std::size_t axis, double x) const {
    const double cell = (x - low_[axis]) * per_length_[axis];
    return static_cast<std::int32_t>(std::min(std::max(cell, 0.0), last_[axis]));
  }
  [[nodiscard]] std::size_t number(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t cell_of(const Point& p) const {
    return number(along(0, p[0]), along(1, p[1]), along(2, p[2]));
  }

 private:
  Point low_{}, per_length_{}, last_{};
  std::array<std::int32_t, 3> size_{1, 1, 1};
};

}  // namespace tess::m2m
