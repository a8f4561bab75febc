// Closes a surface that has holes. Every directed edge of a closed surface has an opposite one; the
// edges without form closed loops, the rim. A cap is a fan of triangles from the centroid of a
// loop. Capped surfaces are closed whatever they were: holes, flipped and missing triangles,
// T-junctions.
//
// A loop in planes of symmetry gets a fan from a point beyond all of its planes instead. No triangle
// of the fan reaches into the domain, so there the winding number is that of the wall with flat caps
// in the planes, and it does not change within rounding of a plane.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/overset/symmetry.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

struct Rim {
  std::size_t n_edges = 0;  ///< of the loops with flat caps
  std::size_t n_loops = 0;
  double cap_share = 0;           ///< area of the flat caps / area of surface and flat caps
  std::size_t n_on_symmetry = 0;  ///< loops in planes of symmetry
  VertexId leaves_at = -1;        ///< a vertex where a loop leaves planes of symmetry, or -1
  VertexId between = -1;  ///< a vertex of a loop in planes with no point beyond all of them, or -1
};

/// Two triangles that pass their common edge in the same direction.
struct SameDirection {
  std::array<std::size_t, 2> triangles{};
  std::pair<VertexId, VertexId> edge;
};

/// The first such edge; none if an edge has more than two triangles.
std::optional<SameDirection> same_direction(std::span<const std::array<VertexId, 3>> triangles);

/// Appends the centroids of the loops to `points` and the caps to `triangles`. Points at the same
/// place are one point; no triangle names a point twice. Points of loops in planes of symmetry are
/// moved onto them.
Rim close(std::vector<Point>& points, std::vector<std::array<VertexId, 3>>& triangles,
          std::span<const SymmetryPlane> symmetry = {});

/// Per plane: the number of edges that lack an opposite one and lie in it.
[[nodiscard]] std::vector<std::size_t> rim_edges_in(
    std::span<const Point> points, std::span<const std::array<VertexId, 3>> triangles,
    std::span<const SymmetryPlane> planes);

}  // namespace tess::m2m
