#include "collide/distance.hpp"

#include "collide/shapes/vector.hpp"

#include <algorithm>

namespace tess::collide {
namespace {

using shapes::ratio;
using shapes::sign_of;
using shapes::way;

double squared_length(double x, double y, double z) noexcept {
  return x * x + y * y + z * z;
}

/// How far along a segment the nearest point is: 0 or 1 at an end.
double nearest_fraction(const Segment& s, const Point& p) noexcept {
  const auto ahead_of = [&](const Point& end) {
    return [&](auto number) { return dot(way(number, s.from, s.to), way(number, end, p)); };
  };
  if (sign_of(ahead_of(s.from)) <= 0) return 0;
  if (sign_of(ahead_of(s.to)) >= 0) return 1;
  return ratio(ahead_of(s.from), [&](auto number) {
    const auto along = way(number, s.from, s.to);
    return dot(along, along);
  });
}

Point point_at(const Segment& s, double t) noexcept {
  if (t == 1) return s.to;
  Point out = s.from;
  for (std::size_t k = 0; k < 3; ++k) out[k] += t * (s.to[k] - s.from[k]);
  return out;
}

Segment edge(const Triangle& t, std::size_t i) noexcept {
  return {t.corners[i], t.corners[(i + 1) % 3]};
}

/// The edge on which the nearest point is, if it is not on the face.
struct NearestEdge {
  Segment edge{};
  double distance2 = HUGE_VAL;
};

NearestEdge nearest_edge(const Triangle& t, const std::array<int, 3>& sides,
                         const Point& p) noexcept {
  NearestEdge nearest{edge(t, 0)};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!shapes::may_be_on_edge(sides, i)) continue;
    const double d = distance2(edge(t, i), p);
    if (d < nearest.distance2) nearest = {edge(t, i), d};
  }
  return nearest;
}

}  // namespace

double distance2(const Point& object, const Point& p) noexcept {
  return squared_length(p[0] - object[0], p[1] - object[1], p[2] - object[2]);
}

double distance2(const Aabb& object, const Point& p) noexcept {
  const auto off = [&](std::size_t k) {
    return std::max({0.0, object.lo[k] - p[k], p[k] - object.hi[k]});
  };
  return squared_length(off(0), off(1), off(2));
}

double distance2(const Segment& object, const Point& p) noexcept {
  const double t = nearest_fraction(object, p);
  if (t == 0) return distance2(object.from, p);
  if (t == 1) return distance2(object.to, p);
  return ratio(
      [&](auto number) {
        const auto off = cross(way(number, object.from, p), way(number, object.from, object.to));
        return dot(off, off);
      },
      [&](auto number) {
        const auto along = way(number, object.from, object.to);
        return dot(along, along);
      });
}

double distance2(const Triangle& object, const Point& p) noexcept {
  const std::array<int, 3> sides = shapes::edge_sides(object.corners, p);
  if (!shapes::is_over_face(sides)) return nearest_edge(object, sides, p).distance2;
  const auto& [a, b, c] = object.corners;
  return ratio(
      [&](auto number) {
        const auto height = dot(cross(way(number, a, b), way(number, a, c)), way(number, a, p));
        return height * height;
      },
      [&](auto number) {
        const auto normal = cross(way(number, a, b), way(number, a, c));
        return dot(normal, normal);
      });
}

double distance2(const Sphere& object, const Point& p) noexcept {
  const double off = std::max(0.0, std::sqrt(distance2(object.centre, p)) - object.radius);
  return off * off;
}

double distance2(const Tetrahedron& object, const Point& p) noexcept {
  if (intersect(object, p, Touching::counts)) return 0;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& c = object.corners;
    least = std::min(least, distance2(Triangle{{c[i], c[(i + 1) % 4], c[(i + 2) % 4]}}, p));
  }
  return least;
}

Point nearest_point(const Triangle& triangle, const Point& p) noexcept {
  const std::array<int, 3> sides = shapes::edge_sides(triangle.corners, p);
  if (!shapes::is_over_face(sides)) {
    const Segment nearest = nearest_edge(triangle, sides, p).edge;
    return point_at(nearest, nearest_fraction(nearest, p));
  }
  const auto& [a, b, c] = triangle.corners;
  Point out = p;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] -= ratio(
        [&](auto number) {
          const auto normal = cross(way(number, a, b), way(number, a, c));
          const auto along_axis = k == 0 ? normal.x : k == 1 ? normal.y : normal.z;
          return dot(normal, way(number, a, p)) * along_axis;
        },
        [&](auto number) {
          const auto normal = cross(way(number, a, b), way(number, a, c));
          return dot(normal, normal);
        });
  return out;
}

}  // namespace tess::collide
