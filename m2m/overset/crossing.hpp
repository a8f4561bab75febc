// Whether the ray from a point in the direction +x passes through a triangle, by exact signs. The
// sum over a closed surface is the winding number of the point.
//
// If the ray meets an edge or a corner, the point counts as moved by (0, e, e²) with e -> 0
// (Edelsbrunner and Mücke 1990, simulation of simplicity). So exactly one of two triangles at an
// edge is passed through, and the sum is right for every point off the surface.
#pragma once

#include "m2m/mesh.hpp"

#include <array>

namespace tess::m2m {

/// A triangle of a surface, its normal given by the order of the corners. Corners at the same place
/// have the same id, so that two triangles at an edge decide alike.
struct WallTriangle {
  std::array<Point, 3> corners{};
  std::array<VertexId, 3> ids{};
};

/// The sign of the normal's x if the ray passes through the triangle, otherwise 0. `p` is not on
/// the triangle. Exact for differences of coordinates that are 0 or from 1e-80 to 1e100.
[[nodiscard]] int crossing(const Point& p, const WallTriangle& triangle);

/// True if `p` lies on the closed triangle, exactly.
[[nodiscard]] bool is_on(const Point& p, const WallTriangle& triangle);

}  // namespace tess::m2m
