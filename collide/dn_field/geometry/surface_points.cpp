#include "collide/dn_field/geometry/surface_points.hpp"

#include <algorithm>

namespace tess::dn {

std::vector<double> area_sums(const Surface& surface) {
  std::vector<double> sums;
  sums.reserve(surface.triangles.size());
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    sums.push_back(sum += 0.5 * norm(cross(b - a, c - a)));
  }
  return sums;
}

SurfacePoint point_on(const Surface& surface, const std::vector<double>& sums, double first,
                      double second, double third) {
  const auto found = std::upper_bound(sums.begin(), sums.end() - 1, first * sums.back());
  const auto triangle = static_cast<std::uint32_t>(found - sums.begin());
  const auto [a, b, c] = surface.corners(triangle);
  const double root = std::sqrt(second);
  return {(1 - root) * a + (root * (1 - third)) * b + (root * third) * c,
          direction(cross(b - a, c - a)), triangle};
}

}  // namespace tess::dn
