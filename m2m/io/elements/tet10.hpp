// Ten-node tetrahedra as quadratic, possibly curved elements. In barycentric coordinates L of the
// reference tetrahedron the shape functions are
//
//     N_i = L_i (2 L_i - 1) at the corners,   N_ij = 4 L_i L_j at the middles of edges,
//
// and map L to the point sum N_k x_k as well as to the value sum N_k u_k. A point is found in the
// straight tetrahedra of split_element.hpp; Newton's method then inverts the map.
#pragma once

#include "m2m/io/elements/split_element.hpp"
#include "m2m/rows/weights/point_rows.hpp"

#include <array>
#include <optional>
#include <span>

namespace tess::m2m {

/// Vertices or points of the element in the order of ExodusII: corners 0 to 3, then the middles of
/// the edges 01, 12, 02, 03, 13, 23.
using Tet10 = std::array<VertexId, 10>;
using Tet10Points = std::array<Point, 10>;
using Tet10Weights = std::array<double, 10>;

/// The shape functions at L. Their sum is 1.
[[nodiscard]] Tet10Weights tet10_shape(const Weights& barycentric);

/// The barycentric coordinates of the point `p`: Newton's method from `start`. Empty if it does not
/// converge to |error| < 1e-12 of the size of the element, if the map folds over on the way, or if
/// a coordinate of the result is below -slack. In curved elements a point beyond the straight faces
/// may lie in the element, and the reverse; 0.1 covers usual curvatures.
[[nodiscard]] std::optional<Weights> tet10_invert(const Point& p, const Tet10Points& nodes,
                                                  const Weights& start, double slack = 0.1);

/// The element of eight consecutive tetrahedra that split_element() made of it.
[[nodiscard]] Tet10 tet10_of(std::span<const Tet, 8> tets);

/// Rows of quadratic interpolation at points, third order. `tets`: eight per element, in order.
/// `points`: placed in these tetrahedra; `positions`: their coordinates. A point where Newton's
/// method fails gets the linear row of its tetrahedron. Returns the number of these in `n_linear`.
[[nodiscard]] Rows<double> tet10_rows(MeshView mesh, std::span<const PointInTet> points,
                                      std::span<const Point> positions, std::size_t& n_linear);

}  // namespace tess::m2m
