// Boxes and the hulls of up to four points: exact separating planes (Gottschalk, Lin and Manocha
// 1996). Those that are parallel to an axis and to an edge of the hull are lines across a
// rectangle, so all signs are those of orientation.hpp.
#include "collide/shapes/convex.hpp"
#include "collide/shapes/orientation.hpp"
#include "collide/tetrahedron.hpp"

#include <algorithm>

namespace tess::collide {
namespace {

using Points = std::span<const Point>;

std::array<Point, 8> corners_of(const Aabb& box) noexcept {
  std::array<Point, 8> corners{};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 3; ++k) corners[i][k] = (i >> k & 1U) != 0 ? box.hi[k] : box.lo[k];
  return corners;
}

/// Whether two sets of signs show that no point is common, or none after a small translation. A
/// plane that contains both shows nothing.
struct Separation {
  int least[2] = {1, 1}, most[2] = {-1, -1};

  void add(std::size_t set, int side) noexcept {
    least[set] = std::min(least[set], side);
    most[set] = std::max(most[set], side);
  }
  [[nodiscard]] bool parts(Touching touching) const noexcept {
    if (touching == Touching::counts) return most[0] < least[1] || most[1] < least[0];
    const bool all_on_it = least[0] == 0 && most[0] == 0 && least[1] == 0 && most[1] == 0;
    return !all_on_it && ((most[0] <= 0 && least[1] >= 0) || (most[1] <= 0 && least[0] >= 0));
  }
};

/// By the plane of a face of the hull.
bool faces_part(Points hull, const std::array<Point, 8>& corners, Touching touching) noexcept {
  for (std::size_t i = 0; i < hull.size(); ++i)
    for (std::size_t j = i + 1; j < hull.size(); ++j)
      for (std::size_t k = j + 1; k < hull.size(); ++k) {
        const shapes::Sides plane(hull[i], hull[j], hull[k]);
        Separation separation;
        for (const Point& p : hull) separation.add(0, plane.of(p));
        for (const Point& p : corners) separation.add(1, plane.of(p));
        if (separation.parts(touching)) return true;
      }
  return false;
}

/// By a plane along an edge of the hull and an axis.
bool edges_part(Points hull, const std::array<Point, 8>& corners, Touching touching) noexcept {
  for (std::size_t i = 0; i < hull.size(); ++i)
    for (std::size_t j = i + 1; j < hull.size(); ++j)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto side = [&](const Point& p) {
          return shapes::orient2d(hull[i], hull[j], p, static_cast<shapes::Dropped>(axis));
        };
        Separation separation;
        for (const Point& p : hull) separation.add(0, side(p));
        for (std::size_t c = 0; c < 8; ++c)
          if ((c >> axis & 1U) == 0) separation.add(1, side(corners[c]));
        if (separation.parts(touching)) return true;
      }
  return false;
}

bool meet(const Aabb& box, Points hull, Touching touching) noexcept {
  const Aabb around = box_around(hull);
  const std::array<Point, 8> corners = corners_of(box);
  if (touching == Touching::does_not_count) {
    // A corner and its three neighbours extend as far as the box does.
    if (!shapes::difference_has_volume({{corners[0], corners[1], corners[2], corners[4]}}, hull))
      return false;
  } else if (std::any_of(hull.begin(), hull.end(),
                         [&](const Point& p) { return overlap(box, box_of(p), touching); })) {
    return true;
  }
  // The faces of the box, then the other planes.
  return overlap(box, around, touching) && !faces_part(hull, corners, touching) &&
         !edges_part(hull, corners, touching);
}

}  // namespace

bool intersect(const Segment& a, const Aabb& b, Touching touching) noexcept {
  return meet(b, std::array{a.from, a.to}, touching);
}
bool intersect(const Triangle& a, const Aabb& b, Touching touching) noexcept {
  return meet(b, a.corners, touching);
}
bool intersect(const Tetrahedron& a, const Aabb& b, Touching touching) noexcept {
  return meet(b, a.corners, touching);
}

}  // namespace tess::collide
