// Hexahedra, wedges, pyramids and ten-node tetrahedra as elements of their own, possibly curved. The
// shape functions N_k map reference coordinates r to the point Σ N_k x_k as well as to the value
// Σ N_k u_k; Newton's method inverts the map. The number of vertices, in the order of ExodusII, says
// the type:
//
//   8   trilinear in the unit cube
//   27  triquadratic there, with vertices in the middles of edges, faces and the element
//   6   linear in a triangle times linear in [0, 1]
//   5   rational (Bedrosian 1992), with s = 1 - z in x, y of [0, s]: x y / s is bilinear at each z,
//       so a pyramid and its neighbours agree on their common faces
//   10  quadratic: L_i (2 L_i - 1) at corners, 4 L_i L_j at middles of edges; r = (L_1, L_2, L_3)
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace tess::m2m {

inline constexpr std::size_t most_native_vertices = 27;

/// Holds the shape function of each vertex; those beyond the element's are 0.
struct ShapeFunctions {
  std::array<double, most_native_vertices> values{};    ///< their sum is 1
  std::array<Point, most_native_vertices> gradients{};  ///< by r
};
/// NaN or infinite at the apex of a pyramid and above it.
[[nodiscard]] ShapeFunctions shape_functions(std::size_t n_vertices, const Point& r);

/// The reference coordinates of a vertex.
[[nodiscard]] Point reference_vertex(std::size_t n_vertices, std::size_t k);

/// The least of the coordinates that are positive within the element and 0 on its faces.
[[nodiscard]] double depth_in_element(std::size_t n_vertices, const Point& r);

/// The reference coordinates of the point `p`: Newton's method from `start`. Empty if it does not
/// converge to |error| < 1e-12 of the size of the element, if the map is not oriented on the way as
/// it is at the centre, since it folds over, or if the result is outside by more than `slack`.
/// Beyond the faces of the split a point may lie in a curved element, and the reverse; 0.1 covers
/// usual curvatures.
[[nodiscard]] std::optional<Point> invert_element(const Point& p, std::span<const Point> vertices,
                                                  const Point& start, double slack = 0.1);

}  // namespace tess::m2m
