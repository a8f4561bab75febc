#include "m2m/rows/search/point_grid.hpp"

#include <utility>

namespace tess::m2m {

PointGrid::PointGrid(std::span<const Point> points)
    : around_(collide::box_around(points)),
      cells_(around_, points.size()),
      first_(cells_.n_cells() + 1),
      points_(points.size()),
      numbers_(points.size()) {
  std::vector<std::uint32_t> cell_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cell_of[i] = static_cast<std::uint32_t>(cells_.cell_of(points[i]));
    ++first_[cell_of[i]];
  }
  std::uint32_t n = 0;
  for (std::uint32_t& first : first_) n += std::exchange(first, n);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t at = first_[cell_of[i]]++;
    points_[at] = points[i];
    numbers_[at] = static_cast<std::uint32_t>(i);
  }
  // Each first has become the first of the next cell.
  for (std::size_t cell = first_.size() - 1; cell > 0; --cell) first_[cell] = first_[cell - 1];
  first_[0] = 0;
}

}  // namespace tess::m2m
