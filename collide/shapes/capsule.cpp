#include "collide/capsule.hpp"

#include <algorithm>
#include <cmath>

namespace tess::collide {
namespace {

double squared_length(const Point& a, const Point& b) noexcept {
  const Point way = difference(b, a);
  return dot(way, way);
}

/// At least the distance of a point from a segment: that to one of its points, in the norm that
/// adds the coordinates up, whose terms do not underflow as squares do.
double distance_bound(const Point& p, const Point& from, const Point& to, double length2) noexcept {
  Point way, rest;
  double along = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    way[k] = to[k] - from[k];
    rest[k] = p[k] - from[k];
    along += way[k] * rest[k];
  }
  // Any share gives a bound.
  const double share = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0;
  double out = 0, size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    out += std::abs(rest[k] - share * way[k]);
    size += std::abs(rest[k]) + std::abs(way[k]);
  }
  // Each of the at most six roundings loses 2^-53 of a number below `size`, or 2^-1074.
  return out + 0x1p-49 * size + 0x1p-1070;
}

}  // namespace

Capsule checked(const Capsule& capsule) noexcept {
  bool is_known = capsule.radius >= 0 && std::isfinite(capsule.radius);
  for (const Point& end : {capsule.from, capsule.to})
    for (const double x : end) is_known = is_known && std::isfinite(x);
  return is_known ? capsule : unknown_capsule;
}

Capsule capsule_around(std::span<const Point> points) noexcept {
  std::size_t from = 0, to = 0;
  double length2 = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double d2 = squared_length(points[i], points[j]);
      if (!(d2 > length2)) continue;
      length2 = d2;
      from = j;
      to = i;
    }
  Capsule out{points[from], points[to], 0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == from || i == to) continue;
    const double d = distance_bound(points[i], out.from, out.to, length2);
    if (d > out.radius || std::isnan(d)) out.radius = d;
  }
  return out;
}

}  // namespace tess::collide
