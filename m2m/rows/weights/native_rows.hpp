// Rows of kind native: the shape functions of the element that a point's tetrahedron was split from.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/weights/point_rows.hpp"

#include <cstddef>

namespace tess::m2m {

/// A point that is placed in a tetrahedron.
struct NativePoint {
  Point at{};
  PointInTet in{};
  bool is_snapped = false;  ///< outside all tetrahedra: it may be in a curved element all the same
};

/// Appends the row of the point. The row is empty where the linear one of the tetrahedron holds: if
/// the tetrahedron is an element itself, for a point at a vertex, and where no inverse of the
/// element's map is found; `n_linear` counts the latter, unless the point is outside.
void add_native_row(const MeshView& mesh, const NativePoint& point, Rows<double>& rows,
                    std::uint64_t& n_linear);

}  // namespace tess::m2m
