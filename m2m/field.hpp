// Values at the vertices of a mesh: several components a vertex, row-major, in the mesh's vertex
// order. What a transfer moves. A manufactured field is a formula in x, y, z, so that a result can
// be compared with the truth anywhere.
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
  std::vector<double> values;  ///< n_points × n_components, row-major
};

/// A scalar function of the place.
using Formula = std::function<double(const Point&)>;

/// "gaussian" (exp(-|r|²), where r runs from -2 to 2 over `domain`'s longest side, from its
/// centre), "linear" (1 + 2x - 3y + 5z), "sin" (sin kx sin ky sin kz, one period over the longest
/// side from its low corner), or an expression such as "x^2 + sin(pi*y)" (fields/expression.hpp).
/// Throws Error (bad_argument) naming the place of the mistake.
[[nodiscard]] Formula make_formula(const std::string& name, const Aabb& domain);

/// The formula at every vertex. Throws Error (bad_value) where it is not finite, naming the vertex.
[[nodiscard]] Field sample(const TetMesh& mesh, const std::string& name, const Formula& formula);

/// How far a scalar transferred field is from the truth, over some vertices: e = value - truth.
struct ErrorNorms {
  double l2 = 0;  ///< sqrt(sum m e²), m the lumped mass of a vertex: a quarter of the volume of its
                  ///< tetrahedra
  double l2_relative = 0;      ///< l2 / sqrt(sum m truth²); l2 where the truth is zero
  double rms = 0;              ///< sqrt(mean of e²)
  double linf = 0;             ///< greatest |e|
  GlobalId worst = 0;          ///< the vertex where |e| is greatest, the first of several
  std::size_t n_vertices = 0;  ///< that count; of none, the norms are NaN
};

/// Norms of values - truth on the mesh that holds the values. `values`, `truth`: one number a
/// vertex. `counts`: which vertices count; empty: all of them.
[[nodiscard]] ErrorNorms error_norms(const TetMesh& mesh, std::span<const double> values,
                                     std::span<const double> truth,
                                     const std::vector<bool>& counts = {});

/// FNV-1a (64 bits) over the bits of the values, byte by byte from the low end, in order: one
/// number for a result.
[[nodiscard]] std::uint64_t result_hash(std::span<const double> values,
                                        std::uint64_t start = 0xcbf29ce484222325U) noexcept;

}  // namespace tess::m2m
