// A tetrahedron with the planes of its faces, made once for all pairs that it is in. Heights of the
// corners of another one above these planes decide in a few nanoseconds whether a face separates
// both. They are rounded: only heights of at least `sure` have the sign of the exact ones.
#pragma once

#include "m2m/mesh.hpp"
#include "runtime/core/simd.hpp"

#include <array>
#include <cstddef>

namespace tess::m2m {

using Corners = std::array<Point, 4>;
/// A number per corner or face of a tetrahedron.
using Four = simd::Vector<double, 4>;
/// Says how high the corners of a tetrahedron lie above the faces of another: heights[face][corner].
using Heights = std::array<Four, 4>;

struct TetPlanes {
  std::array<Four, 3> at{};  ///< per axis: the coordinates of the corners
  double sixfold = 0;        ///< six times the volume, with its sign; exactly 0 if there is none
  double reach = 0;          ///< the greatest coordinate of an edge from corner 0
  /// Per axis and face: the height of p above it is normal·(p - corner 0) + base. A height is six
  /// times the volume of the tetrahedron over the face, so that four heights add up to |sixfold|.
  std::array<Four, 3> normal{};
  Four base{};

  TetPlanes() = default;
  explicit TetPlanes(const Corners& c);
  [[nodiscard]] Corners corners() const {
    Corners c;
    for (std::size_t v = 0; v < 4; ++v) c[v] = {at[0][v], at[1][v], at[2][v]};
    return c;
  }
};

/// Where the boxes of both touch, no height is farther from the exact one than this. (With e and r
/// for both reaches, a difference of coordinates is at most 2 (e + r). A normal has components of
/// at most 6 e², with an error of 36 e² units of rounding. Three products and their sums make
/// 360 e² (e + r) units of that.)
[[nodiscard]] inline double sure_height(const TetPlanes& above, const TetPlanes& of) {
  return 0x1p-44 * above.reach * above.reach * (above.reach + of.reach);
}

[[nodiscard]] inline Heights heights(const TetPlanes& above, const TetPlanes& of) {
  std::array<Four, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = of.at[k] - above.at[k][0];
  Heights result;
  for (std::size_t f = 0; f < 4; ++f)
    result[f] = above.base[f] + (p[0] * above.normal[0][f] +
                                 (p[1] * above.normal[1][f] + p[2] * above.normal[2][f]));
  return result;
}

/// True if a face has all of these heights clearly below it.
[[nodiscard]] inline bool is_apart(const Heights& h, double sure) {
  bool apart = false;
  for (const Four& of_face : h) apart |= simd::bits(of_face < -sure) == 0xF;
  return apart;
}

}  // namespace tess::m2m
