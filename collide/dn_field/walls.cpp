#include "collide/dn_field/walls.hpp"

#include "runtime/base/mix.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr std::size_t n_places = 1024;
constexpr double opposite = -0.87;  // cosine of 30° off
constexpr double behind = 1e-6;     // of the extent: what is just inside

struct Place {
  Vec3 at, normal;
};

/// Evenly over the area: the i-th in the i-th of as many equal parts of it.
std::vector<Place> places_on(const Surface& surface, const Bvh& tree) {
  std::vector<double> area_up_to;
  double area = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    area_up_to.push_back(area += 0.5 * norm(cross(b - a, c - a)));
  }
  std::vector<Place> places;
  if (!(area > 0)) return places;
  for (std::size_t i = 0; i < n_places; ++i) {
    const double wanted = area * (static_cast<double>(i) + tess::unit(mix(3 * i))) / n_places;
    const auto t = static_cast<std::size_t>(
        std::min(std::ranges::upper_bound(area_up_to, wanted), area_up_to.end() - 1) -
        area_up_to.begin());
    const double root = std::sqrt(tess::unit(mix(3 * i + 1))), v = tess::unit(mix(3 * i + 2));
    const auto [a, b, c] = surface.corners(t);
    places.push_back({(1 - root) * a + root * (1 - v) * b + root * v * c,
                      tree.normal(static_cast<std::uint32_t>(t))});
  }
  return places;
}

double thickness_at(const Place& place, const Bvh& tree, double extent) {
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
  std::vector<double> result;
  for (const Place& place : places_on(surface, tree))
    if (!(place.normal == Vec3{})) result.push_back(thickness_at(place, tree, extent));
  std::ranges::sort(result);
  return result;
}

double share_thinner(const std::vector<double>& thicknesses, double length) {
  if (thicknesses.empty()) return 0;
  const auto n = std::ranges::lower_bound(thicknesses, length) - thicknesses.begin();
  return static_cast<double>(n) / static_cast<double>(thicknesses.size());
}

}  // namespace tess::dn
