// Tetrahedra, their boxes, and exact tests against points, segments, triangles, balls, boxes and
// each other. A tetrahedron is solid: what lies inside intersects it.
//
// The tests are exact for all finite coordinates, degenerate tetrahedra included (those without
// volume). If touching does not count, the intersection must survive every small enough
// translation: a point must be strictly inside, two tetrahedra must have common interior.
#pragma once

#include "collide/sphere.hpp"

namespace tess::collide {

/// Four corners in either order.
struct Tetrahedron {
  std::array<Point, 4> corners;

  friend bool operator==(const Tetrahedron&, const Tetrahedron&) = default;
};

/// The smallest box that contains the tetrahedron.
[[nodiscard]] inline Aabb box_of(const Tetrahedron& tetrahedron) noexcept {
  return box_around(tetrahedron.corners);
}

/// A capsule around the longest edge.
[[nodiscard]] inline Capsule capsule_of(const Tetrahedron& tetrahedron) noexcept {
  return capsule_around(tetrahedron.corners);
}

[[nodiscard]] bool intersect(const Tetrahedron& a, const Tetrahedron& b,
                             Touching touching) noexcept;
[[nodiscard]] bool intersect(const Tetrahedron& a, const Point& b, Touching touching) noexcept;
[[nodiscard]] bool intersect(const Tetrahedron& a, const Segment& b, Touching touching) noexcept;
[[nodiscard]] bool intersect(const Tetrahedron& a, const Triangle& b, Touching touching) noexcept;
[[nodiscard]] bool intersect(const Tetrahedron& a, const Sphere& b, Touching touching) noexcept;

[[nodiscard]] inline bool intersect(const Point& a, const Tetrahedron& b,
                                    Touching touching) noexcept {
  return intersect(b, a, touching);
}
[[nodiscard]] inline bool intersect(const Segment& a, const Tetrahedron& b,
                                    Touching touching) noexcept {
  return intersect(b, a, touching);
}
[[nodiscard]] inline bool intersect(const Triangle& a, const Tetrahedron& b,
                                    Touching touching) noexcept {
  return intersect(b, a, touching);
}
[[nodiscard]] inline bool intersect(const Sphere& a, const Tetrahedron& b,
                                    Touching touching) noexcept {
  return intersect(b, a, touching);
}

/// Tests against a box, which is solid, are exact as well.
[[nodiscard]] bool intersect(const Tetrahedron& a, const Aabb& b, Touching touching) noexcept;
[[nodiscard]] inline bool intersect(const Aabb& a, const Tetrahedron& b,
                                    Touching touching) noexcept {
  return intersect(b, a, touching);
}

}  // namespace tess::collide
