// A straight segment, its box, and exact tests against other segments and boxes.
#pragma once

#include "collide/capsule.hpp"

namespace tess::collide {

/// The points between two ends, which may coincide.
struct Segment {
  Point from;
  Point to;

  friend bool operator==(const Segment&, const Segment&) = default;
};

/// The smallest box that contains the segment.
[[nodiscard]] inline Aabb box_of(const Segment& segment) noexcept {
  return box_around(std::array{segment.from, segment.to});
}

/// The segment itself.
[[nodiscard]] inline Capsule capsule_of(const Segment& segment) noexcept {
  return {segment.from, segment.to, 0};
}

/// Whether two segments have a common point: exact for all finite coordinates. If touching does not
/// count, never: two segments come apart by a small translation.
[[nodiscard]] bool intersect(const Segment& a, const Segment& b, Touching touching) noexcept;

/// Tests against a box, which is solid, are exact as well.
[[nodiscard]] bool intersect(const Segment& a, const Aabb& b, Touching touching) noexcept;
[[nodiscard]] inline bool intersect(const Aabb& a, const Segment& b, Touching touching) noexcept {
  return intersect(b, a, touching);
}

}  // namespace tess::collide
