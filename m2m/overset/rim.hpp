// Closes a surface that has holes. Every directed edge of a closed surface has an opposite one; the
// edges without form closed loops, the rim. A cap is a fan of triangles from the centroid of a loop.
// Capped surfaces are closed whatever they were: holes, flipped and missing triangles, T-junctions.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tess::m2m {

struct Rim {
  std::size_t n_edges = 0;
  std::size_t n_loops = 0;
  double cap_share = 0;  ///< area of the caps / area of surface and caps
};

/// Appends the centroids of the loops to `points` and the caps to `triangles`. Points at the same
/// place are one point; no triangle names a point twice.
Rim close(std::vector<Point>& points, std::vector<std::array<VertexId, 3>>& triangles);

}  // namespace tess::m2m
