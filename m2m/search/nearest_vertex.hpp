// The vertex nearest to a point, through a grid of cells searched in growing shells. For the policy
// `nearest`, and for one part of a source mesh as well: the nearest of several parts is the least
// (distance, global id).
#pragma once

#include "m2m/search/cell_grid.hpp"

#include <cstdint>
#include <span>

namespace tess::m2m {

class NearestVertex {
 public:
  struct Answer {
    std::int32_t vertex;      ///< index into the points; of several as near, the lowest
    double squared_distance;  ///< from coordinate differences
  };
  /// Keeps a view of the points, which must live longer. There is at least one.
  explicit NearestVertex(std::span<const Point> points);
  [[nodiscard]] Answer find(const Point& p) const;

 private:
  std::span<const Point> points_;
  CellGrid grid_;
};

}  // namespace tess::m2m
