#include "collide/triangle.hpp"

#include "collide/shapes/convex.hpp"
#include "collide/shapes/determinant.hpp"
#include "collide/shapes/sign_of.hpp"

namespace tess::collide {
namespace {

using shapes::Dropped;
using shapes::orient2d;
using shapes::orient3d;
using shapes::Sides;
using Signs = std::array<int, 3>;

Sides plane_of(const Triangle& t) noexcept {
  return {t.corners[0], t.corners[1], t.corners[2]};
}

bool all_on_one_side(const Signs& s) noexcept {
  return s[0] != 0 && s[0] == s[1] && s[0] == s[2];
}
bool all_in_plane(const Signs& s) noexcept {
  return s == Signs{};
}
bool on_both_sides(const Signs& s) noexcept {
  return (s[0] > 0 || s[1] > 0 || s[2] > 0) && (s[0] < 0 || s[1] < 0 || s[2] < 0);
}

/// The corner of a triangle that a plane parts from the other two, and whether it is above them.
struct Alone {
  std::size_t corner = 0;
  bool is_above = true;
};

Alone alone(const Signs& s) noexcept {
  std::array<std::size_t, 3> count{}, last{};  // below, on, above
  for (std::size_t i = 0; i < 3; ++i) {
    const auto side = static_cast<std::size_t>(s[i] + 1);
    ++count[side];
    last[side] = i;
  }
  if (count[2] == 1) return {last[2], true};
  if (count[0] == 1) return {last[0], false};
  return {last[1], count[0] == 2};  // one corner touches the plane from below or from above
}

/// Two triangles that meet each other's plane, renumbered (Devillers and Guigue 2003): p is alone
/// above the other triangle's plane, or on it, and q and r are below or on it. Each triangle meets
/// the line that the planes have in common in an interval, [pr, pq] of the first and [pq, pr] of
/// the second, in the same direction.
struct Arrangement {
  const Point *p1, *q1, *r1;
  const Point *p2, *q2, *r2;

  Arrangement(const Triangle& a, const Signs& a_signs, const Triangle& b,
              const Signs& b_signs) noexcept {
    const Alone first = alone(a_signs), second = alone(b_signs);
    p1 = &a.corners[first.corner];
    q1 = &a.corners[(first.corner + 1) % 3];
    r1 = &a.corners[(first.corner + 2) % 3];
    p2 = &b.corners[second.corner];
    q2 = &b.corners[(second.corner + 1) % 3];
    r2 = &b.corners[(second.corner + 2) % 3];
    if (!first.is_above) std::swap(q2, r2);
    if (!second.is_above) std::swap(q1, r1);
  }

  /// The order on the line: of where p1 x1 meets it to where p2 x2 does.
  [[nodiscard]] int order(const Point* x1, const Point* x2) const noexcept {
    return orient3d(*p1, *x1, *p2, *x2);
  }
  [[nodiscard]] bool intervals_meet(Touching touching) const noexcept {
    const int limit = touching == Touching::counts ? 0 : -1;
    return order(q1, q2) <= limit && order(r1, r2) >= -limit;
  }
};

/// Whether an edge of `t` has all corners of `other` on its outer side, in a projection in which
/// `t` runs in direction `turn`.
bool has_separating_edge(const Triangle& t, int turn, const Triangle& other,
                         Dropped axis) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = t.corners[i], &q = t.corners[(i + 1) % 3];
    if (orient2d(p, q, other.corners[0], axis) == -turn &&
        orient2d(p, q, other.corners[1], axis) == -turn &&
        orient2d(p, q, other.corners[2], axis) == -turn)
      return true;
  }
  return false;
}

/// Two triangles of which the first is in the plane of the second, or the second is degenerate.
bool intersect_flat(const Triangle& a, const Triangle& b) noexcept {
  for (const Dropped axis : {Dropped::z, Dropped::x, Dropped::y}) {
    const int b_turn = orient2d(b.corners[0], b.corners[1], b.corners[2], axis);
    if (b_turn == 0) continue;
    const int a_turn = orient2d(a.corners[0], a.corners[1], a.corners[2], axis);
    if (a_turn == 0) break;
    return !has_separating_edge(a, a_turn, b, axis) && !has_separating_edge(b, b_turn, a, axis);
  }
  return shapes::hulls_intersect(a.corners, b.corners);  // one is degenerate
}

/// Where from-to meets the plane of a triangle. The ends are on different sides, or one is on it.
Point meeting_point(const Point& from, const Point& to, const Triangle& plane) noexcept {
  const auto& [a, b, c] = plane.corners;
  // Of the heights of the two ends above the plane.
  const double t = shapes::ratio(
      [&](auto number) {
        return shapes::determinant(number, {a, b}, {a, c}, {a, from});
      },
      [&](auto number) {
        return shapes::determinant(number, {a, b}, {a, c}, {to, from});
      });
  if (t == 0) return from;
  if (t == 1) return to;
  Point out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = (1 - t) * from[k] + t * to[k];
  return out;
}

Signs sides(const Sides& plane, const Triangle& t) noexcept {
  return {plane.of(t.corners[0]), plane.of(t.corners[1]), plane.of(t.corners[2])};
}
Signs certain_sides(const Sides& plane, const Triangle& t) noexcept {
  return {plane.certain(t.corners[0]), plane.certain(t.corners[1]), plane.certain(t.corners[2])};
}

}  // namespace

bool intersect(const Segment& a, const Segment& b, Touching touching) noexcept {
  if (touching == Touching::does_not_count) return false;
  return shapes::hulls_intersect(std::array{a.from, a.to}, std::array{b.from, b.to});
}

bool intersect(const Point& a, const Triangle& b, Touching touching) noexcept {
  return touching == Touching::counts && shapes::hulls_intersect({&a, 1}, b.corners);
}

bool intersect(const Segment& a, const Triangle& b, Touching touching) noexcept {
  const std::array ends{a.from, a.to};
  return touching == Touching::counts ? shapes::hulls_intersect(ends, b.corners)
                                      : shapes::hulls_cross(ends, b.corners);
}

bool intersect(const Triangle& a, const Triangle& b, Touching touching) noexcept {
  const Sides plane_b = plane_of(b);
  Signs a_signs = certain_sides(plane_b, a);
  if (all_on_one_side(a_signs)) return false;
  const Sides plane_a = plane_of(a);
  Signs b_signs = certain_sides(plane_a, b);
  if (all_on_one_side(b_signs)) return false;
  for (std::size_t i = 0; i < 3; ++i)
    if (a_signs[i] == 0) a_signs[i] = plane_b.of(a.corners[i]);
  if (all_on_one_side(a_signs)) return false;
  if (all_in_plane(a_signs) && touching == Touching::counts) return intersect_flat(a, b);
  for (std::size_t i = 0; i < 3; ++i)
    if (b_signs[i] == 0) b_signs[i] = plane_a.of(b.corners[i]);
  if (all_on_one_side(b_signs)) return false;
  if (all_in_plane(a_signs) || all_in_plane(b_signs)) {
    if (touching == Touching::counts) return intersect_flat(b, a);
    // One plane contains both, or one is degenerate.
    return !(all_in_plane(a_signs) && all_in_plane(b_signs)) &&
           shapes::hulls_cross(a.corners, b.corners);
  }
  if (touching == Touching::does_not_count && !(on_both_sides(a_signs) && on_both_sides(b_signs)))
    return false;
  return Arrangement(a, a_signs, b, b_signs).intervals_meet(touching);
}

std::optional<Segment> contact_segment(const Triangle& a, const Triangle& b) noexcept {
  const Signs a_signs = sides(plane_of(b), a), b_signs = sides(plane_of(a), b);
  if (all_on_one_side(a_signs) || all_on_one_side(b_signs) || all_in_plane(a_signs) ||
      all_in_plane(b_signs))
    return std::nullopt;
  const Arrangement t(a, a_signs, b, b_signs);
  if (!t.intervals_meet(Touching::counts)) return std::nullopt;
  const bool a_begins = t.order(t.r1, t.q2) <= 0;  // the greater of the two first ends
  const bool a_ends = t.order(t.q1, t.r2) >= 0;    // the lesser of the two last ends
  return Segment{a_begins ? meeting_point(*t.p1, *t.r1, b) : meeting_point(*t.p2, *t.q2, a),
                 a_ends ? meeting_point(*t.p1, *t.q1, b) : meeting_point(*t.p2, *t.r2, a)};
}

}  // namespace tess::collide
