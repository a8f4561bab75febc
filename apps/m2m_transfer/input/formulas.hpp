// What is known of a manufactured field and of a mesh, for bounds of the error.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "m2m/placement.hpp"

#include <optional>
#include <string>

namespace m2m_transfer {

/// The largest second derivative in any direction, max |D²f|, of a field of make_formula(); empty
/// for expressions.
[[nodiscard]] std::optional<double> largest_second_derivative(const std::string& field,
                                                              const Aabb& domain);

/// The edge of a cube with the volume of six average tetrahedra: 1/N for kuhn:N.
[[nodiscard]] double typical_edge(const MeshSurvey& mesh);

/// A bound of the error of linear interpolation in tetrahedra whose edges are at most `longest`:
/// (3/16) h² max |D²f|. The error is at most R²/2 max |D²f|, where R is the radius of the smallest
/// ball that holds the tetrahedron (Waldron 1998, theorem 3.1), and R² is at most 3/8 h² (Jung 1901).
[[nodiscard]] constexpr double linear_bound(double longest, double second_derivative) {
  return 3.0 / 16 * longest * longest * second_derivative;
}

}  // namespace m2m_transfer
