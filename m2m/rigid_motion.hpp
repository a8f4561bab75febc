// A rigid motion of a mesh: a rotation about an axis, then a translation. Vectors and tensors in the
// frame of the body turn with it:
//
//     move_points(points, motion);
//     turn_vectors(velocity, motion);        // now in the fixed frame
//     turn_vectors(velocity, {.axis = motion.axis, .angle = -motion.angle});   // and back
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

/// Turns vectors: n × 3 values, row-major. Quarter turns about an axis of coordinates are exact.
/// Throws Error (bad_argument) for such an axis, or if the values are no whole rows.
void turn_vectors(std::span<double> values, const RigidMotion& motion);
/// Turns tensors likewise, T to R T Rᵀ: n × 9 values, each tensor row by row.
void turn_tensors(std::span<double> values, const RigidMotion& motion);
/// Turns symmetric tensors likewise: n × 6 values in the order xx, yy, zz, xy, yz, xz.
void turn_symmetric_tensors(std::span<double> values, const RigidMotion& motion);

}  // namespace tess::m2m
