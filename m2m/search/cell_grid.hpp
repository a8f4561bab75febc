// A uniform grid of cells over a box, and the items that overlap each cell, as one array (counted,
// then filled). For the serial search. Immutable after it is built.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class CellGrid {
 public:
  using Cell = std::array<std::int32_t, 3>;

  /// About `n_cells` cells, as near to cubes as the box allows; each of `items` is listed in every
  /// cell that its box touches.
  CellGrid(const Aabb& domain, std::size_t n_cells, std::span<const Aabb> items);

  /// The cell of a point; of a point outside, the nearest.
  [[nodiscard]] Cell cell_of(const Point& p) const;
  /// The items that touch a cell, ascending.
  [[nodiscard]] std::span<const std::int32_t> items(const Cell& cell) const;

 private:
  [[nodiscard]] std::size_t index(const Cell& cell) const;

  Point low_{};
  Point cells_a_length_{};
  Cell shape_{1, 1, 1};
  std::vector<std::int64_t> begin_;
  std::vector<std::int32_t> items_;
};

}  // namespace tess::m2m
