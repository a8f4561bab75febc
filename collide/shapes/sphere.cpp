#include "collide/sphere.hpp"

#include "collide/shapes/sign_of.hpp"
#include "collide/shapes/vector.hpp"

namespace tess::collide {
namespace {

using shapes::sign_of;
using shapes::way;

/// Whether a squared distance minus a squared radius, of this sign, is an intersection.
bool is_within(int sign, Touching touching) noexcept {
  return touching == Touching::counts ? sign <= 0 : sign < 0;
}

bool is_strictly_inside(const Point& p, const Aabb& box) noexcept {
  for (std::size_t k = 0; k < 3; ++k)
    if (p[k] <= box.lo[k] || p[k] >= box.hi[k]) return false;
  return true;
}

/// a + b rounded toward `limit`, an infinity.
double rounded_sum(double a, double b, double limit) noexcept {
  const double sum = a + b;
  const double added = sum - a;
  const double lost = (a - (sum - added)) + (b - added);  // exact (Knuth)
  const bool is_beyond = limit > 0 ? lost <= 0 : lost >= 0;
  return is_beyond ? sum : std::nextafter(sum, limit);
}

}  // namespace

Aabb box_of(const Sphere& sphere) noexcept {
  if (!(sphere.radius >= 0)) return no_box<double, 3>();
  Aabb out{};
  for (std::size_t k = 0; k < 3; ++k) {
    out.lo[k] = rounded_sum(sphere.centre[k], -sphere.radius, -HUGE_VAL);
    out.hi[k] = rounded_sum(sphere.centre[k], sphere.radius, HUGE_VAL);
  }
  return out;
}

bool intersect(const Sphere& a, const Sphere& b, Touching touching) noexcept {
  const int sign = sign_of([&](auto number) {
    const auto d = way(number, a.centre, b.centre);
    const auto reach = number(a.radius) + number(b.radius);
    return dot(d, d) - reach * reach;
  });
  return is_within(sign, touching);
}

bool intersect(const Sphere& a, const Point& b, Touching touching) noexcept {
  return intersect(a, Sphere{b, 0}, touching);
}

bool intersect(const Sphere& a, const Segment& b, Touching touching) noexcept {
  const Point& p = a.centre;
  const auto ahead_of = [&](const Point& end) {
    return sign_of(
        [&](auto number) { return dot(way(number, b.from, b.to), way(number, end, p)); });
  };
  if (ahead_of(b.from) <= 0) return intersect(a, b.from, touching);
  if (ahead_of(b.to) >= 0) return intersect(a, b.to, touching);
  const int sign = sign_of([&](auto number) {
    const auto along = way(number, b.from, b.to);
    const auto off = cross(way(number, b.from, p), along);
    const auto radius = number(a.radius);
    return dot(off, off) - radius * radius * dot(along, along);
  });
  return is_within(sign, touching);
}

bool intersect(const Sphere& s, const Triangle& t, Touching touching) noexcept {
  const auto& [a, b, c] = t.corners;
  const std::array<int, 3> sides = shapes::edge_sides(t.corners, s.centre);
  if (shapes::is_over_face(sides)) {
    const int sign = sign_of([&](auto number) {
      const auto normal = cross(way(number, a, b), way(number, a, c));
      const auto height = dot(normal, way(number, a, s.centre));
      const auto radius = number(s.radius);
      return height * height - radius * radius * dot(normal, normal);
    });
    return is_within(sign, touching);
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (shapes::may_be_on_edge(sides, i) &&
        intersect(s, Segment{t.corners[i], t.corners[(i + 1) % 3]}, touching))
      return true;
  return false;
}

bool intersect(const Sphere& a, const Aabb& b, Touching touching) noexcept {
  if (touching == Touching::does_not_count && is_strictly_inside(a.centre, b)) return true;
  Point nearest = a.centre;
  for (std::size_t k = 0; k < 3; ++k)
    nearest[k] = nearest[k] < b.lo[k] ? b.lo[k] : nearest[k] > b.hi[k] ? b.hi[k] : nearest[k];
  return intersect(a, nearest, touching);
}

}  // namespace tess::collide
