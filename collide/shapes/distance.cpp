#include "collide/distance.hpp"

#include "collide/shapes/vector.hpp"

#include <algorithm>

namespace tess::collide {
namespace {

using shapes::ratio;
using shapes::sign_of;
using shapes::way;

/// On which part of a segment the nearest point is.
enum class SegmentPart { from, between, to };

SegmentPart nearest_part(const Segment& s, const Point& p) noexcept {
  const auto ahead_of = [&](const Point& end) {
    return sign_of(
        [&](auto number) { return dot(way(number, s.from, s.to), way(number, end, p)); });
  };
  if (ahead_of(s.from) <= 0) return SegmentPart::from;
  return ahead_of(s.to) >= 0 ? SegmentPart::to : SegmentPart::between;
}

/// The way from `p` to the nearest point.
Point offset_to(const Segment& s, const Point& p) noexcept {
  const SegmentPart part = nearest_part(s, p);
  if (part == SegmentPart::from) return difference(s.from, p);
  if (part == SegmentPart::to) return difference(s.to, p);
  Point out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = ratio(
        [&](auto number) {
          const auto along = way(number, s.from, s.to);
          return (number(s.from[k]) - number(p[k])) * dot(along, along) +
                 (number(s.to[k]) - number(s.from[k])) * dot(along, way(number, s.from, p));
        },
        [&](auto number) {
          const auto along = way(number, s.from, s.to);
          return dot(along, along);
        });
  return out;
}

/// How far the nearest point, which is between the ends, is on the way from one to the other.
double part_of_way(const Point& from, const Point& to, const Point& p) noexcept {
  return ratio([&](auto number) { return dot(way(number, from, to), way(number, from, p)); },
               [&](auto number) {
                 const auto along = way(number, from, to);
                 return dot(along, along);
               });
}

Segment edge(const Triangle& t, std::size_t i) noexcept {
  return {t.corners[i], t.corners[(i + 1) % 3]};
}

}  // namespace

double distance2(const Point& object, const Point& p) noexcept {
  const Point way = difference(p, object);
  return dot(way, way);
}

double distance2(const Aabb& object, const Point& p) noexcept {
  const auto off = [&](std::size_t k) {
    return std::max({0.0, object.lo[k] - p[k], p[k] - object.hi[k]});
  };
  const Point way{off(0), off(1), off(2)};
  return dot(way, way);
}

double distance2(const Segment& object, const Point& p) noexcept {
  const SegmentPart part = nearest_part(object, p);
  if (part == SegmentPart::from) return distance2(object.from, p);
  if (part == SegmentPart::to) return distance2(object.to, p);
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
  if (!shapes::is_over_face(sides)) {
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < 3; ++i)
      if (shapes::may_be_on_edge(sides, i)) least = std::min(least, distance2(edge(object, i), p));
    return least;
  }
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

Point offset_to(const Triangle& triangle, const Point& p) noexcept {
  const std::array<int, 3> sides = shapes::edge_sides(triangle.corners, p);
  if (!shapes::is_over_face(sides)) {
    // By lengths, which do not leave the range of a double as their squares do.
    Point nearest{};
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!shapes::may_be_on_edge(sides, i)) continue;
      const Point offset = offset_to(edge(triangle, i), p);
      const double length = std::hypot(offset[0], offset[1], offset[2]);
      if (length > least) continue;
      least = length;
      nearest = offset;
    }
    return nearest;
  }
  const auto& [a, b, c] = triangle.corners;
  const auto normal = [&](auto number) { return cross(way(number, a, b), way(number, a, c)); };
  return {
      ratio([&](auto n) { return dot(normal(n), way(n, p, a)) * normal(n).x; },
            [&](auto n) { return dot(normal(n), normal(n)); }),
      ratio([&](auto n) { return dot(normal(n), way(n, p, a)) * normal(n).y; },
            [&](auto n) { return dot(normal(n), normal(n)); }),
      ratio([&](auto n) { return dot(normal(n), way(n, p, a)) * normal(n).z; },
            [&](auto n) { return dot(normal(n), normal(n)); }),
  };
}

std::array<double, 2> nearest_weights(const Segment& segment, const Point& p) noexcept {
  const SegmentPart part = nearest_part(segment, p);
  if (part == SegmentPart::from) return {1, 0};
  if (part == SegmentPart::to) return {0, 1};
  return {part_of_way(segment.to, segment.from, p), part_of_way(segment.from, segment.to, p)};
}

std::array<double, 3> nearest_weights(const Triangle& triangle, const Point& p) noexcept {
  const auto& c = triangle.corners;
  const std::array<int, 3> sides = shapes::edge_sides(c, p);
  std::array<double, 3> weights{};
  if (shapes::is_over_face(sides)) {
    const auto normal = [&](auto number) {
      return cross(way(number, c[0], c[1]), way(number, c[0], c[2]));
    };
    for (std::size_t i = 0; i < 3; ++i)
      if (sides[i] != 0)
        weights[(i + 2) % 3] = ratio(
            [&](auto number) {
              return dot(normal(number),
                         cross(way(number, c[i], c[(i + 1) % 3]), way(number, c[i], p)));
            },
            [&](auto number) { return dot(normal(number), normal(number)); });
    return weights;
  }
  // On an edge if the nearest point of its line is between its ends, which holds for one edge beyond
  // which `p` is at most; otherwise at the end of two of them.
  for (std::size_t i = 0; i < 3; ++i)
    if (shapes::may_be_on_edge(sides, i) &&
        nearest_part(edge(triangle, i), p) == SegmentPart::between) {
      const auto [from, to] = nearest_weights(edge(triangle, i), p);
      weights[i] = from;
      weights[(i + 1) % 3] = to;
      return weights;
    }
  for (std::size_t i = 0; i < 3; ++i)
    if (nearest_part(edge(triangle, i), p) == SegmentPart::from &&
        nearest_part({c[i], c[(i + 2) % 3]}, p) == SegmentPart::from) {
      weights[i] = 1;
      break;
    }
  return weights;
}

Point nearest_point(const Triangle& triangle, const Point& p) noexcept {
  const Point offset = offset_to(triangle, p);
  return {p[0] + offset[0], p[1] + offset[1], p[2] + offset[2]};
}

}  // namespace tess::collide
