#include "collide/dn_field/bvh.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double way_slack = 1e-9;  // of the segment, for rounding

/// Whether the segment meets the box, up to rounding.
bool may_meet(const Bounds& box, Vec3 from, Vec3 way) {
  const auto [first, last] = box.part_of_line(from, way);
  return std::max(first, 0.0) - way_slack <= std::min(last, 1.0) + way_slack;
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
  tree_.descend([&](std::uint32_t at) {
    const Node& node = tree_.nodes()[at];
    if (!may_meet(node.box, from, way)) return false;
    Tree::each_place(node, [&](std::uint32_t i) {
      if (const double part = crossing_at(from, way, prepared_[i].corner); part > 0)
        into.push_back({part, tree_.object(i)});
    });
    return true;
  });
}

}  // namespace tess::dn
