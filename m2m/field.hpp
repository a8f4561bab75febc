// Values at the vertices of a mesh. A transfer moves fields from one mesh to another. A
// manufactured field is a formula in x, y and z, so that the result of a transfer can be compared
// with the exact value at any point.
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tess::m2m {

struct Field {
  std::string name;
  std::size_t n_components = 1;
  std::vector<double> values;  ///< n_points × n_components, row-major, in the order of the vertices
};

/// A scalar function of a point.
using Formula = std::function<double(const Point&)>;

/// `name` is one of these, or an expression such as "x^2 + sin(pi*y)" (fields/expression.hpp):
///
///     gaussian   exp(-|r|²); r runs from -2 to 2 over the longest side of `domain`
///     linear     1 + 2x - 3y + 5z
///     sin        sin kx sin ky sin kz; one period over the longest side of `domain`
///
/// Throws Error (bad_argument) with the position of the mistake in the expression.
[[nodiscard]] Formula make_formula(const std::string& name, const Aabb& domain);

/// A field that each part evaluates at its own points.
struct FormulaField {
  std::string name;  ///< for make_formula()
  Aabb domain{};
};

/// Evaluates the formula at every vertex. Throws Error (bad_value) with the vertex if a value is
/// not finite.
[[nodiscard]] Field sample(const TetMesh& mesh, const std::string& name, const Formula& formula);

/// The error of sample().
[[nodiscard]] std::string not_finite_text(const std::string& field, double value, GlobalId vertex,
                                          const std::string& mesh, const Point& at);

/// Norms of the error e = value - truth of a scalar field, over some or all vertices. The mass m of
/// a vertex is a quarter of the volume of its tetrahedra.
struct ErrorNorms {
  double l2 = 0;               ///< sqrt(sum m e²)
  double l2_relative = 0;      ///< l2 / sqrt(sum m truth²); l2 if the truth is zero everywhere
  double rms = 0;              ///< sqrt(mean of e²)
  double linf = 0;             ///< maximum of |e|
  GlobalId worst = 0;          ///< the vertex with the largest |e|; the first if there are several
  std::size_t n_vertices = 0;  ///< vertices included; without any, the norms are NaN
};

/// FNV-1a (64 bits) over the bits of the values in order, each value from its lowest byte on. The
/// result of one call can be the `start` of the next.
[[nodiscard]] std::uint64_t result_hash(std::span<const double> values,
                                        std::uint64_t start = 0xcbf29ce484222325U) noexcept;

}  // namespace tess::m2m
