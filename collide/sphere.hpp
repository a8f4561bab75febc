// Balls, their boxes, and exact tests against points, segments, triangles, boxes and each other. A
// ball is solid: what lies inside intersects it.
//
// Squared distances are compared exactly for all finite numbers; rounding never decides. If
// touching does not count, the distance must be less than the radius. A ball of radius zero is a
// point.
#pragma once

#include "collide/triangle.hpp"

namespace tess::collide {

/// All points within `radius` of `centre`. `radius` is finite and not negative.
struct Sphere {
  Point centre;
  double radius;

  friend bool operator==(const Sphere&, const Sphere&) = default;
};

/// The smallest box of doubles that contains the ball: rounded outward by at most one unit in the
/// last place. It is not valid (is_valid()) if the radius is negative or NaN, or if a face
/// overflows.
[[nodiscard]] Aabb box_of(const Sphere& sphere) noexcept;

[[nodiscard]] bool intersect(const Sphere& a, const Sphere& b, Touching touching) noexcept;
[[nodiscard]] bool intersect(const Sphere& a, const Point& b, Touching touching) noexcept;
[[nodiscard]] bool intersect(const Sphere& a, const Segment& b, Touching touching) noexcept;
[[nodiscard]] bool intersect(const Sphere& a, const Triangle& b, Touching touching) noexcept;
/// If touching does not count, a ball of radius zero must be strictly inside of the box.
[[nodiscard]] bool intersect(const Sphere& a, const Aabb& b, Touching touching) noexcept;

[[nodiscard]] inline bool intersect(const Point& a, const Sphere& b, Touching touching) noexcept {
  return intersect(b, a, touching);
}
[[nodiscard]] inline bool intersect(const Segment& a, const Sphere& b, Touching touching) noexcept {
  return intersect(b, a, touching);
}
[[nodiscard]] inline bool intersect(const Triangle& a, const Sphere& b,
                                    Touching touching) noexcept {
  return intersect(b, a, touching);
}
[[nodiscard]] inline bool intersect(const Aabb& a, const Sphere& b, Touching touching) noexcept {
  return intersect(b, a, touching);
}

}  // namespace tess::collide
