// Planes of symmetry: flat sides of the domain on which bodies stand. Meshes hold half a body, or a
// quarter on two planes. Nothing of the domain lies beyond a plane: points of a mesh that reaches
// beyond one, as when a whole body moves through it, are blanked.
//
//     ● ● ● ● ● ●
//     ● ● ╭───╮ ●     the rim of the wall lies in the plane: the wall is closed beyond it (rim.hpp)
//     ●━●━┷━━━┷━●     faces of a mesh in the plane are neither wall nor outer boundary
//          ╲ ╱
#pragma once

#include "m2m/mesh.hpp"

#include <cmath>
#include <span>
#include <string>

namespace tess::m2m {

struct SymmetryPlane {
  Point normal{0, 0, 1};  ///< of length 1, into the domain
  double offset = 0;      ///< normal · x of its points
  double tolerance = 0;   ///< points as near as this lie in the plane; in units of the mesh

  /// The distance of a point; negative beyond the plane.
  [[nodiscard]] double height(const Point& p) const { return dot(normal, p) - offset; }
  [[nodiscard]] bool holds(const Point& p) const { return std::abs(height(p)) <= tolerance; }
  [[nodiscard]] bool is_beyond(const Point& p) const { return height(p) < -tolerance; }
  friend bool operator==(const SymmetryPlane&, const SymmetryPlane&) = default;
};

/// The plane normal · x = offset, as a side of the domain that `points` fill. `normal`: of any
/// length but zero. The tolerance is 1e-9 of the longest side of their box. Throws Error
/// (bad_argument) if points lie on both sides, or none in the plane.
[[nodiscard]] SymmetryPlane symmetry_plane(const Point& normal, double offset,
                                           std::span<const Point> points);

/// Moves points that lie in a plane onto it: to the last bit if the plane is across an axis.
void project(std::span<Point> points, std::span<const SymmetryPlane> planes);

/// "z=0.5", or "0.6:0.8:0=2" for 0.6 x + 0.8 y = 2.
[[nodiscard]] std::string text_of(const SymmetryPlane& plane);
/// "z=0,y=1".
[[nodiscard]] std::string text_of(std::span<const SymmetryPlane> planes);

}  // namespace tess::m2m
