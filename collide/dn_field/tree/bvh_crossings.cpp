#include "collide/dn_field/bvh.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double way_slack = 1e-9;  // of the segment, for rounding

/// Whether the segment meets the box, up to rounding.
bool may_meet(const Bounds& box, Vec3 from, Vec3 way) {
  double first = -way_slack, last = 1 + way_slack;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = component(from, axis), d = component(way, axis);
    const double low = component(box.low, axis) - at, high = component(box.high, axis) - at;
    if (d == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    first = std::max(first, std::min(low / d, high / d) - way_slack);
    last = std::min(last, std::max(low / d, high / d) + way_slack);
  }
  return first <= last;
}

/// The fraction at which the segment crosses the triangle (Möller and Trumbore 1997), from either
/// side; negative if it does not. Triangles are slightly enlarged, so that no segment passes
/// between two.
double crossing_at(Vec3 from, Vec3 way, const std::array<Vec3, 3>& corner) {
  constexpr double none = -1, larger = 1e-9;
  const auto& [a, b, c] = corner;
  const Vec3 ab = b - a, ac = c - a, h = cross(way, ac);
  const double determinant = dot(ab, h);
  if (determinant == 0) return none;
  const Vec3 s = from - a;
  const double u = dot(s, h) / determinant;
  const Vec3 q = cross(s, ab);
  const double v = dot(way, q) / determinant, t = dot(ac, q) / determinant;
  return u >= -larger && v >= -larger && u + v <= 1 + larger && t > 0 && t <= 1 ? t : none;
}

}  // namespace

void Bvh::crossings(Vec3 from, Vec3 to, std::vector<Crossing>& into) const {
  const Vec3 way = to - from;
  std::array<std::uint32_t, max_depth> stack{};
  std::size_t height = 1;  // the root
  while (height > 0) {
    const Node& node = nodes_[stack[--height]];
    if (!may_meet(node.box, from, way)) continue;
    if (node.count == 0) {
      stack[height++] = node.first;
      stack[height++] = node.first + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (const double at = crossing_at(from, way, prepared_[i].corner); at > 0)
        into.push_back({at, order_[i]});
  }
}

}  // namespace tess::dn
