// The point of a tetrahedron that is nearest to a point outside. A pure function: the same bits on
// every PE.
#pragma once

#include "m2m/rows/interpolate/locate.hpp"

namespace tess::m2m {

struct NearestPoint {
  Weights weights;  ///< of the nearest point, per corner; none is negative, and their sum is 1
  double distance;  ///< from p, in units of the mesh, to about 16 ulps of the largest edge
};

/// `p` is not inside. The nearest point is a corner, or on an edge or a face; of several with equal
/// distance, the first of these. The tetrahedron may be flat. For edges from 1e-80 to 1e100.
[[nodiscard]] NearestPoint nearest_point(const Point& p, const std::array<Point, 4>& corners);

}  // namespace tess::m2m
