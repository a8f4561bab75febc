// The time of the inside test against the size of the wall.
#pragma once

#include "apps/kit/rows.hpp"

#include <string>
#include <vector>

namespace overset {

/// A wall of one size, and a million random points in its box.
struct WallRow {
  std::size_t n_triangles = 0;
  double build = 0;  ///< processor time in seconds
  double ns = 0;     ///< the same per point
  std::size_t n_inside = 0;
};

/// Sizes up to 1e5 triangles. `shape` as in body.hpp. 200 of the points are compared with sums of
/// solid angles; a difference ends the program.
[[nodiscard]] std::vector<WallRow> wall_study(const std::string& shape);
[[nodiscard]] const kit::Rows<WallRow>& wall_report();

}  // namespace overset
