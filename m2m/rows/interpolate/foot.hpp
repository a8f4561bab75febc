// The foot of a point on a cell: the nearest point of a closed triangle or edge, or of the faces of a
// tetrahedron that does not hold the point. The functions are pure: they give the same bits on every
// PE.
//
//            p                 The foot is in the face, in an edge or at a corner. Plain floating
//            |  distance       point decides which if an error bound allows it, and otherwise exact
//      a ----+---- b           numbers do (collide/distance.hpp).
//       \   foot  /
//          \   /               An edge gives two triangles the same distance, bit for bit, whatever
//            c                 the order of its ends: then the lower id decides between them.
//
// Guarantees, for edges from 1e-80 to 1e100 and any flatness:
//   - the feature that holds the foot is decided exactly, and corners beside it have the weight 0;
//   - weights are within 1e-12 of the exact ones, and none is negative;
//   - the distance is 0 if and only if the point lies on the cell, and at most some ulps of the
//     largest edge off; it is not below that of a box around the cell, but for a factor of 1 - 1e-12.
#pragma once

#include "m2m/rows/interpolate/locate.hpp"

#include <cstdint>

namespace tess::m2m {

struct Foot {
  double distance;       ///< from the point, in units of the mesh
  std::uint8_t feature;  ///< a bit per corner of the face, edge or corner that holds it
};

/// `dimension`: of the cell, whose last vertex is repeated (TetMesh::dimension).
[[nodiscard]] Foot foot_of(const Point& p, const std::array<Point, 4>& corners,
                           std::int32_t dimension);

/// True for a triangle that is farther from `p` than the root of `squared_distance`, as far as its
/// edges show it at a glance: a search looks at several times as many triangles as it needs.
[[nodiscard]] bool is_beyond(const Point& p, const std::array<Point, 4>& corners,
                             double squared_distance);

/// The foot as a location. The status is `inside` in the face of a triangle or between the ends of an
/// edge, `boundary` at their rims, and `snapped` if the point is not on the cell.
[[nodiscard]] Location location_of(const Foot& foot, const Point& p,
                                   const std::array<Point, 4>& corners, std::int32_t dimension);

/// On which side of a triangle's plane the point is: 1 where its normal (b - a) × (c - a) points to,
/// -1 on the other side, 0 in the plane. Exact.
[[nodiscard]] int side_of(const Point& p, const std::array<Point, 4>& corners);

}  // namespace tess::m2m
