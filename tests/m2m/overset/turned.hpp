// A plane of symmetry after a rigid motion.
#pragma once

#include "m2m/overset.hpp"
#include "m2m/rigid_motion.hpp"

namespace tess::test {

inline m2m::SymmetryPlane turned(const m2m::SymmetryPlane& plane, const m2m::RigidMotion& motion) {
  std::array<m2m::Point, 2> line{};
  for (std::size_t k = 0; k < 3; ++k) line[0][k] = plane.offset * plane.normal[k];
  for (std::size_t k = 0; k < 3; ++k) line[1][k] = line[0][k] + plane.normal[k];
  move_points(line, motion);
  const m2m::Point normal = m2m::difference(line[1], line[0]);
  return {normal, m2m::dot(normal, line[0]), plane.tolerance};
}

}  // namespace tess::test
