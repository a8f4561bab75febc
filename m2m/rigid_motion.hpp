// A rigid motion of a mesh: a rotation about an axis, then a translation.
#pragma once

#include "m2m/mesh.hpp"

#include <span>

namespace tess::m2m {

struct RigidMotion {
  Point axis{0, 0, 1};    ///< of the rotation; any length but zero
  double angle = 0;       ///< in radians, counter-clockwise around the axis
  Point centre{0, 0, 0};  ///< a point on the axis
  Point translation{0, 0, 0};
};

/// Moves the points. The result for a point depends on this point only, so a vertex that several
/// parts hold stays the same in all of them, bit for bit. Throws Error (bad_argument) for a
/// rotation about an axis without a length.
void move_points(std::span<Point> points, const RigidMotion& motion);

}  // namespace tess::m2m
