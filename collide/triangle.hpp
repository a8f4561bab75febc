// Triangles: box, exact test of intersection, contact segment.
//
// The test is exact for all finite coordinates: rounding never decides it. Degenerate triangles
// (segments, points) and triangles in one plane are decided as exactly as all others.
#pragma once

#include "collide/segment.hpp"

#include <optional>

namespace tess::collide {

/// Three corners. Degenerate triangles are allowed.
template <class Real>
struct TriangleOf {
  std::array<std::array<Real, 3>, 3> corners;

  friend bool operator==(const TriangleOf&, const TriangleOf&) = default;
};
using Triangle = TriangleOf<double>;

/// The smallest box that contains the triangle.
template <class Real>
[[nodiscard]] Box<Real, 3> box_of(const TriangleOf<Real>& triangle) noexcept {
  return box_around(triangle.corners);
}

/// A capsule around the longest edge.
[[nodiscard]] inline Capsule capsule_of(const Triangle& triangle) noexcept {
  return capsule_around(triangle.corners);
}

/// Whether two triangles have a common point (Devillers and Guigue 2003, on exact signs).
///
/// If touching does not count, the intersection must survive every small enough translation of one
/// triangle, as that of two open boxes does: the relative interiors have a common point, and the
/// triangles do not lie in one plane or in parallel planes.
[[nodiscard]] bool intersect(const Triangle& a, const Triangle& b, Touching touching) noexcept;

/// The same tests for a point or a segment and a triangle.
[[nodiscard]] bool intersect(const Point& a, const Triangle& b, Touching touching) noexcept;
[[nodiscard]] bool intersect(const Segment& a, const Triangle& b, Touching touching) noexcept;
[[nodiscard]] inline bool intersect(const Triangle& a, const Point& b, Touching touching) noexcept {
  return intersect(b, a, touching);
}
[[nodiscard]] inline bool intersect(const Triangle& a, const Segment& b,
                                    Touching touching) noexcept {
  return intersect(b, a, touching);
}

/// Tests against a box, which is solid, are exact as well.
[[nodiscard]] bool intersect(const Triangle& a, const Aabb& b, Touching touching) noexcept;
[[nodiscard]] inline bool intersect(const Aabb& a, const Triangle& b, Touching touching) noexcept {
  return intersect(b, a, touching);
}

/// Floats are converted to double, which is exact.
[[nodiscard]] inline Triangle in_double(const TriangleOf<float>& t) noexcept {
  Triangle out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) out.corners[i][k] = double{t.corners[i][k]};
  return out;
}
[[nodiscard]] inline Capsule capsule_of(const TriangleOf<float>& triangle) noexcept {
  return capsule_of(in_double(triangle));
}
[[nodiscard]] inline bool intersect(const TriangleOf<float>& a, const TriangleOf<float>& b,
                                    Touching touching) noexcept {
  return intersect(in_double(a), in_double(b), touching);
}

/// The segment that two triangles in different planes have in common; both ends are equal if they
/// touch in one point. There is none if the triangles do not intersect, lie in one plane, or if one
/// is degenerate. Exact signs decide between which edges it lies; each coordinate is then within
/// 2^-42 of the largest coordinate of the two triangles, however small the angle between them.
[[nodiscard]] std::optional<Segment> contact_segment(const Triangle& a, const Triangle& b) noexcept;

}  // namespace tess::collide
