#include "collide/dn_field/walls.hpp"

#include "collide/dn_field/surface_points.hpp"
#include "runtime/base/mix.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr std::size_t n_places = 1024;
constexpr double opposite = -0.87;  // cosine of 30° off
constexpr double behind = 1e-6;     // of the extent: what is just inside

double thickness_at(const SurfacePoint& place, const Bvh& tree, double extent) {
  const Vec3 inward = -place.normal, from = place.at + behind * extent * inward;
  if (!tree.is_inside(from)) return 0;
  std::vector<Crossing> crossings;
  tree.crossings(from, from + extent * inward, crossings);
  std::ranges::sort(crossings, {}, &Crossing::at);
  int depth = 1;  // closed parts may overlap
  for (const Crossing& crossing : crossings) {
    const double facing = dot(tree.normal(crossing.triangle), place.normal);
    depth += facing > 0 ? 1 : -1;
    if (depth == 0) return facing < opposite ? (crossing.at + behind) * extent : HUGE_VAL;
  }
  return HUGE_VAL;
}

}  // namespace

std::vector<double> wall_thicknesses(const Surface& surface, const Bvh& tree) {
  const double extent = norm(bounds(surface).size());
  const std::vector<double> sums = area_sums(surface);
  std::vector<double> result;
  if (!(sums.back() > 0)) return result;
  for (std::size_t i = 0; i < n_places; ++i) {
    // The i-th in the i-th of as many equal parts of the area.
    const double part = (static_cast<double>(i) + tess::unit(mix(3 * i))) / n_places;
    const SurfacePoint place =
        point_on(surface, sums, part, tess::unit(mix(3 * i + 1)), tess::unit(mix(3 * i + 2)));
    if (!(place.normal == Vec3{})) result.push_back(thickness_at(place, tree, extent));
  }
  std::ranges::sort(result);
  return result;
}

double share_thinner(const std::vector<double>& thicknesses, double length) {
  if (thicknesses.empty()) return 0;
  const auto n = std::ranges::lower_bound(thicknesses, length) - thicknesses.begin();
  return static_cast<double>(n) / static_cast<double>(thicknesses.size());
}

}  // namespace tess::dn
