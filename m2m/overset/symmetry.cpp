#include "m2m/overset/symmetry.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::m2m {

SymmetryPlane symmetry_plane(const Point& normal, double offset, std::span<const Point> points) {
  const double size = collide::length(normal);
  if (!(size > 0 && std::isfinite(size) && std::isfinite(offset)))
    fail(ErrorCode::bad_argument, "the plane of symmetry ", text_of({normal, offset}),
         " is none; its normal needs a length, and its numbers must be finite");
  const Aabb box = collide::box_around(points);
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, box.hi[k] - box.lo[k]);
  SymmetryPlane plane{normal, offset / size, 1e-9 * longest};
  for (double& x : plane.normal) x /= size;
  double low = 0, high = 0, nearest = HUGE_VAL;
  for (const Point& p : points) {
    const double height = plane.height(p);
    low = std::min(low, height);
    high = std::max(high, height);
    nearest = std::min(nearest, std::abs(height));
  }
  const bool is_above = low >= -plane.tolerance;
  if (!is_above && high > plane.tolerance)
    fail(ErrorCode::bad_argument, text_of(plane), " is no plane of symmetry: the domain reaches ",
         -low, " to one side of it and ", high, " to the other; give a side of the domain");
  if (nearest > plane.tolerance)
    fail(ErrorCode::bad_argument, text_of(plane), " is no plane of symmetry: the domain ends ",
         nearest, " from it; give a side of the domain");
  if (!is_above) {
    for (double& x : plane.normal) x = 0 - x;
    plane.offset = 0 - plane.offset;
  }
  return plane;
}

void project(std::span<Point> points, std::span<const SymmetryPlane> planes) {
  for (Point& p : points)
    for (const SymmetryPlane& plane : planes) {
      if (!plane.holds(p)) continue;
      const double height = plane.height(p);
      for (std::size_t k = 0; k < 3; ++k) p[k] -= height * plane.normal[k];
    }
}

std::string text_of(const SymmetryPlane& plane) {
  const auto& n = plane.normal;
  for (std::size_t k = 0; k < 3; ++k)
    if (n[k] != 0 && n[(k + 1) % 3] == 0 && n[(k + 2) % 3] == 0)
      return text("xyz"[k], '=', plane.offset / n[k]);
  return text(n[0], ':', n[1], ':', n[2], '=', plane.offset);
}

std::string text_of(std::span<const SymmetryPlane> planes) {
  std::string out;
  for (const SymmetryPlane& plane : planes) {
    if (!out.empty()) out += ',';
    out += text_of(plane);
  }
  return out;
}

}  // namespace tess::m2m
