// A triangle in space and its bounding box. Deciding whether two triangles meet is the narrow
// phase, which stands elsewhere; the broad phase sees only the box.
#pragma once

#include "collide/aabb.hpp"

namespace tess::collide {

/// Three corners; degenerate triangles are allowed.
struct Triangle {
  std::array<Point, 3> corners;

  friend bool operator==(const Triangle&, const Triangle&) = default;
};

/// The smallest box that holds the triangle.
[[nodiscard]] inline Aabb box_of(const Triangle& triangle) noexcept {
  const auto& [a, b, c] = triangle.corners;
  return merged(merged(box_of(a), box_of(b)), box_of(c));
}

}  // namespace tess::collide
