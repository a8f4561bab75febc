// Closes a surface that has holes. Every directed edge of a closed surface has an opposite one; the
// edges without form closed loops, the rim. A cap is a fan of triangles from the centroid of a
// loop. Capped surfaces are closed whatever they were: holes, flipped and missing triangles,
// T-junctions.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

struct Rim {
  std::size_t n_edges = 0;
  std::size_t n_loops = 0;
  double cap_share = 0;  ///< area of the caps / area of surface and caps
};

/// Two triangles that pass their common edge in the same direction.
struct SameDirection {
  std::array<std::size_t, 2> triangles{};
  std::pair<VertexId, VertexId> edge;
};

/// The first such edge of a surface each of whose edges has two triangles; of any other surface
/// none.
std::optional<SameDirection> same_direction(std::span<const std::array<VertexId, 3>> triangles);

/// Appends the centroids of the loops to `points` and the caps to `triangles`. Points at the same
/// place are one point; no triangle names a point twice.
Rim close(std::vector<Point>& points, std::vector<std::array<VertexId, 3>>& triangles);

}  // namespace tess::m2m
