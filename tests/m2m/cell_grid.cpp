#include "tests/m2m/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace tess::test {

CellGrid::CellGrid(const Aabb& domain, std::size_t n_cells, std::span<const Aabb> items)
    : low_(domain.lo) {
  Point side{};
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    side[axis] = domain.hi[axis] - domain.lo[axis];
    longest = std::max(longest, side[axis]);
  }
  // A thin direction gets one cell, and the others share the cells.
  double product = 1;
  for (double& s : side) product *= std::max(s / longest, 1e-3);
  const double cell =
      longest > 0
          ? longest * std::cbrt(product / static_cast<double>(std::max<std::size_t>(n_cells, 1)))
          : 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(side[axis] > 0)) continue;
    shape_[axis] =
        static_cast<std::int32_t>(std::clamp(std::floor(side[axis] / cell), 1.0, 1024.0));
    cells_per_length_[axis] = shape_[axis] / side[axis];
  }
  begin_.assign(static_cast<std::size_t>(shape_[0]) * static_cast<std::size_t>(shape_[1]) *
                        static_cast<std::size_t>(shape_[2]) +
                    1,
                0);
  const auto for_each_cell = [&](const Aabb& box, auto&& visit) {
    const Cell first = cell_of(box.lo), last = cell_of(box.hi);
    for (std::int32_t z = first[2]; z <= last[2]; ++z) {
      for (std::int32_t y = first[1]; y <= last[1]; ++y)
        for (std::int32_t x = first[0]; x <= last[0]; ++x) visit(index({x, y, z}));
    }
  };
  for (const Aabb& box : items) for_each_cell(box, [&](std::size_t c) { ++begin_[c + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  items_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<std::int64_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < items.size(); ++i) {
    for_each_cell(items[i], [&](std::size_t c) {
      items_[static_cast<std::size_t>(next[c]++)] = static_cast<std::int32_t>(i);
    });
  }
}

CellGrid::Cell CellGrid::cell_of(const Point& p) const {
  Cell cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Monotonic in p, so a point in a box lies in a cell of the box.
    const double at = (p[axis] - low_[axis]) * cells_per_length_[axis];
    cell[axis] =
        static_cast<std::int32_t>(std::clamp(at, 0.0, static_cast<double>(shape_[axis] - 1)));
  }
  return cell;
}

std::span<const std::int32_t> CellGrid::items(const Cell& cell) const {
  const std::size_t c = index(cell);
  return std::span(items_).subspan(static_cast<std::size_t>(begin_[c]),
                                   static_cast<std::size_t>(begin_[c + 1] - begin_[c]));
}

std::size_t CellGrid::index(const Cell& cell) const {
  return static_cast<std::size_t>(cell[0]) +
         static_cast<std::size_t>(shape_[0]) *
             (static_cast<std::size_t>(cell[1]) +
              static_cast<std::size_t>(shape_[1]) * static_cast<std::size_t>(cell[2]));
}

}  // namespace tess::test
