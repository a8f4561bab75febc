#include "m2m/overset/crossing.hpp"

#include "collide/triangle.hpp"
#include "m2m/rows/interpolate/orientation.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// (b - a) × (p - a) in the plane (y, z), rounded, with the exact sign.
double orientation_yz(const Point& a, const Point& b, const Point& p) {
  const double left = (b[1] - a[1]) * (p[2] - a[2]), right = (b[2] - a[2]) * (p[1] - a[1]);
  const double area = left - right;
  constexpr double bound = 3.3306690738754716e-16;  // Shewchuk 1997, ccwerrboundA
  if (std::abs(area) > bound * (std::abs(left) + std::abs(right))) return area;
  return orientation({0, p[1], p[2]}, {0, a[1], a[2]}, {0, b[1], b[2]}, {1, p[1], p[2]});
}

/// The side of the edge between two corners, seen along x, on which `p` lies after it was moved: 1 or
/// -1. It is computed from the lower id, so that two triangles at the edge agree.
int side(const Point& p, const WallTriangle& t, std::size_t i, std::size_t k) {
  const int flip = t.ids[i] < t.ids[k] ? 1 : -1;
  const Point &a = t.corners[flip > 0 ? i : k], &b = t.corners[flip > 0 ? k : i];
  const double area = orientation_yz(a, b, p);
  if (area != 0) return area > 0 ? flip : -flip;
  if (b[2] != a[2]) return b[2] < a[2] ? flip : -flip;
  return b[1] >= a[1] ? flip : -flip;
}

}  // namespace

int crossing(const Point& p, const WallTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  for (const std::size_t k : {1U, 2U})
    if (std::min({a[k], b[k], c[k]}) > p[k] || std::max({a[k], b[k], c[k]}) < p[k]) return 0;
  if (std::max({a[0], b[0], c[0]}) < p[0]) return 0;
  const int s = side(p, triangle, 0, 1);
  if (side(p, triangle, 1, 2) != s || side(p, triangle, 2, 0) != s) return 0;
  if (std::min({a[0], b[0], c[0]}) > p[0]) return s;
  return (orientation(p, a, b, c) > 0) == (s > 0) ? s : 0;
}

bool is_on(const Point& p, const WallTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  return orientation(p, a, b, c) == 0 &&
         collide::intersect(p, collide::Triangle{triangle.corners}, collide::Touching::counts);
}

}  // namespace tess::m2m
