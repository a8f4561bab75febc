// A uniform grid of cells over a box, with the list of items that overlap each cell, for the search
// of the serial transfer. It does not change after it is built.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::test {

using m2m::Aabb, m2m::Point;

class CellGrid {
 public:
  using Cell = std::array<std::int32_t, 3>;

  /// About `n_cells` cells, nearly cubes if the box allows it. Each of `items` is listed in every
  /// cell that its box touches.
  CellGrid(const Aabb& domain, std::size_t n_cells, std::span<const Aabb> items);

  /// The cell of a point; for a point outside, the nearest cell.
  [[nodiscard]] Cell cell_of(const Point& p) const;
  /// The items that touch a cell, in ascending order.
  [[nodiscard]] std::span<const std::int32_t> items(const Cell& cell) const;

 private:
  [[nodiscard]] std::size_t index(const Cell& cell) const;

  Point low_{}, cells_per_length_{};
  Cell shape_{1, 1, 1};
  std::vector<std::int64_t> begin_;
  std::vector<std::int32_t> items_;
};

}  // namespace tess::test
