// Rows that evaluate a field at points: one row per point, over the vertices of the part that holds
// the point.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/rows/weights/rows.hpp"

#include <cstdint>
#include <span>

namespace tess::m2m {

/// The tetrahedron that holds a point, by its position in the part, and the weights of its corners
/// (locate.hpp).
struct PointInTet {
  std::int32_t tet = -1;
  Weights weights{};
};

/// Linear interpolation. Second order: the error is at most (3/16) h² max|D²u|, h the longest edge.
/// A point at a vertex gets a row of one weight, 1, so the value of the vertex is copied.
[[nodiscard]] Rows<double> linear_rows(std::span<const Tet> tets,
                                       std::span<const PointInTet> points);

/// The value of the nearest vertex, which NearestVertex finds. First order. A point without one
/// (vertex -1) gets an empty row.
[[nodiscard]] Rows<double> nearest_rows(std::span<const VertexId> vertices);

}  // namespace tess::m2m
