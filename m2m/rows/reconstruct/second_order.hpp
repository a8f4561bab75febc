// Reconstruction at points from values and recovered gradients (gradients.hpp). A field at
// vertices:
//
//     u(x) = sum over corners i of w_i (u_i + ½ g_i·(x - x_i)),   w_i the barycentric weights of x
//
// blends expansions about the four corners. With the factor ½ the result is exact for quadratic
// fields, if the gradients are, so its error is O(h³); with the factor 1, which Taylor's expansion
// suggests, it is O(h²). It is continuous, and at a corner the value is that of the vertex.
//
// A field in tetrahedra:  u(x) = u_T + g_T·(x - centroid of T), O(h²), with jumps between them.
//
// Neither is bounded by the values near x. Limiting is done after it, on request.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/weights/point_rows.hpp"
#include "m2m/rows/weights/rows.hpp"

#include <array>
#include <span>
#include <vector>

namespace tess::m2m {

/// What the reconstruction at a point is clamped to.
enum class Limit : std::uint8_t {
  none,
  tetrahedron,  ///< the values at the corners: monotone, second order at extrema
  patch,        ///< the values at all neighbours of the corners: keeps the third order nearly
                ///< everywhere, and still creates no new extremum
};

/// ½ w_i (x - x_i) per corner, x = sum of w_i x_i. From differences of corners, so it loses no
/// digit far from the origin.
[[nodiscard]] std::array<Point, 4> second_order_arms(const Weights& weights,
                                                     const std::array<Point, 4>& corners);

/// Evaluates a field at points. `values`: vertices × n_components, row-major. `gradients`: of the
/// same shape, at least at the corners of the tetrahedra named (apply(gradient_rows())).
/// `patch_ranges`: of the same shape (vertex_ranges()), for Limit::patch; empty otherwise.
/// `out`: points × n_components. A point at a vertex gets its value, bit for bit.
void second_order_values(MeshView mesh, std::span<const PointInTet> points,
                         std::span<const double> values, std::span<const Point> gradients,
                         std::size_t n_components, Limit limit,
                         std::span<const ValueRange> patch_ranges, std::span<double> out);

/// The same without a limit as rows over vertices, for transfers that store weights: `gradients`
/// has a row per vertex of the mesh. About 30 to 60 weights per row.
[[nodiscard]] Rows<double> second_order_rows(MeshView mesh, std::span<const PointInTet> points,
                                             const Rows<Point>& gradients);

/// Per vertex and component: the range of the values at the vertex and at its neighbours within the
/// part; the caller merges copies.
[[nodiscard]] std::vector<ValueRange> vertex_ranges(MeshView mesh, std::span<const double> values,
                                                    std::size_t n_components);

/// The mean of the corners, per cell: targets of a transfer into a field in tetrahedra.
[[nodiscard]] std::vector<Point> centroids(MeshView mesh);

/// Evaluates a field in tetrahedra at points. `values`, `gradients`: tetrahedra × n_components.
/// With empty `gradients` the field is constant in each tetrahedron.
void cell_values(MeshView mesh, std::span<const PointInTet> points, std::span<const double> values,
                 std::span<const Point> gradients, std::size_t n_components, std::span<double> out);

/// The same as rows over tetrahedra. `gradients`: a row per tetrahedron, or no rows for a field
/// that is constant in each.
[[nodiscard]] Rows<double> cell_rows(MeshView mesh, std::span<const PointInTet> points,
                                     const Rows<Point>& gradients);

/// The values of a field in tetrahedra at the four corners of each, 4 tetrahedra × n_components:
/// the unknowns of Basis::corner. Their mean is the value of the tetrahedron, so integrals stay.
[[nodiscard]] std::vector<double> corner_values(MeshView mesh, std::span<const double> values,
                                                std::span<const Point> gradients,
                                                std::size_t n_components);

/// Shortens the gradient of each tetrahedron until its values at the corners are within the range
/// of the values of the tetrahedra that share a vertex with it (Barth and Jespersen 1989, "The
/// design and application of upwind schemes on unstructured meshes", equation 19).
void limit_cell_gradients(MeshView mesh, std::span<const double> values, std::size_t n_components,
                          std::span<Point> gradients);

}  // namespace tess::m2m
