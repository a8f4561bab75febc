// A triangle and its bounding box. The broad phase uses only the box. Whether two triangles
// intersect is left to the caller.
#pragma once

#include "collide/box.hpp"

namespace tess::collide {

/// Three corners. Degenerate triangles are allowed.
struct Triangle {
  std::array<Point, 3> corners;

  friend bool operator==(const Triangle&, const Triangle&) = default;
};

/// The smallest box that contains the triangle.
[[nodiscard]] inline Aabb box_of(const Triangle& triangle) noexcept {
  const auto& [a, b, c] = triangle.corners;
  return merged(merged(box_of(a), box_of(b)), box_of(c));
}

}  // namespace tess::collide
