#include "m2m/search/nearest_vertex.hpp"

#include "runtime/check.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace tess::m2m {
namespace {

CellGrid grid_of(std::span<const Point> points) {
  TESS_CHECK(!points.empty(), "expected at least one point");
  std::vector<Aabb> boxes;
  for (const Point& p : points) boxes.push_back(box_of(p));
  return CellGrid(box_around(points), points.size() / 2, boxes);
}

}  // namespace

NearestVertex::NearestVertex(std::span<const Point> points)
    : points_(points), grid_(grid_of(points)) {}

NearestVertex::Answer NearestVertex::find(const Point& p) const {
  Answer best{-1, std::numeric_limits<double>::infinity()};
  const auto look = [&](const CellGrid::Cell& cell) {
    for (const std::int32_t v : grid_.items(cell)) {
      const Point& at = points_[static_cast<std::size_t>(v)];
      const double x = at[0] - p[0], y = at[1] - p[1], z = at[2] - p[2];
      const double squared = x * x + y * y + z * z;
      if (squared < best.squared_distance || (squared == best.squared_distance && v < best.vertex))
        best = {v, squared};
    }
  };
  const CellGrid::Cell centre = grid_.cell_of(p);
  const CellGrid::Cell& shape = grid_.shape();
  const std::int32_t last = std::max({shape[0], shape[1], shape[2]});
  for (std::int32_t shell = 0; shell <= last; ++shell) {
    // All cells of this shell and beyond are at least (shell - 1) cells away; the factor absorbs
    // the rounding of cell_of.
    const double away = (shell - 1) * grid_.least_side() * (1 - 1e-9);
    if (best.vertex >= 0 && shell > 1 && away * away > best.squared_distance) break;
    const auto range = [&](std::size_t axis) {
      return std::pair(std::max(centre[axis] - shell, 0),
                       std::min(centre[axis] + shell, shape[axis] - 1));
    };
    const auto [x0, x1] = range(0);
    const auto [y0, y1] = range(1);
    const auto [z0, z1] = range(2);
    for (std::int32_t z = z0; z <= z1; ++z) {
      for (std::int32_t y = y0; y <= y1; ++y) {
        const bool face = std::abs(z - centre[2]) == shell || std::abs(y - centre[1]) == shell;
        for (std::int32_t x = x0; x <= x1; ++x) {
          if (face || std::abs(x - centre[0]) == shell) look({x, y, z});
        }
      }
    }
  }
  return best;
}

}  // namespace tess::m2m
