#include "collide/dn_field/walls.hpp"

#include "collide/dn_field/surface.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr std::size_t places_asked = 1024;
constexpr std::size_t most_triangles = 4096;
constexpr double opposite = -0.87;  // cosine of 30° off
constexpr double behind = 1e-6;     // of the extent: offset to the inside

struct Wall {
  double thickness;
  bool slanted;
};

Wall wall_at(Vec3 at, Vec3 normal, const Bvh& tree, double extent) {
  const Vec3 inward = -normal, from = at + behind * extent * inward;
  if (!tree.is_inside(from)) return {0, false};
  std::vector<Crossing> crossings;
  tree.crossings(from, from + extent * inward, crossings);
  std::ranges::sort(crossings, {}, &Crossing::at);
  int depth = 1;  // closed parts may overlap
  for (const Crossing& crossing : crossings) {
    const double facing = dot(tree.normal(crossing.triangle), normal);
    depth += facing > 0 ? 1 : -1;
    if (depth == 0) return {(crossing.at + behind) * extent, facing > opposite};
  }
  return {HUGE_VAL, false};
}

double count_thinner(const std::vector<double>& sorted, double length) {
  return static_cast<double>(std::ranges::lower_bound(sorted, length) - sorted.begin());
}

}  // namespace

Walls walls_of(const Surface& surface, const Bvh& tree) {
  const double extent = norm(bounds(surface).size());
  const std::vector<double> sums = area_sums(surface);
  Walls walls;
  if (!(sums.back() > 0)) return walls;
  const auto look = [&](Vec3 at, Vec3 normal) {
    const Wall wall = wall_at(at, normal, tree, extent);
    walls.least = std::min(walls.least, wall.thickness);
    return wall;
  };
  for (std::size_t i = 0; i < places_asked; ++i) {
    // Stratified: one place in each of as many equal parts of the area.
    const double part = (static_cast<double>(i) + tess::unit(mix(3 * i))) / places_asked;
    const SurfacePoint place =
        point_on(surface, sums, part, tess::unit(mix(3 * i + 1)), tess::unit(mix(3 * i + 2)));
    if (place.normal == Vec3{}) continue;
    const Wall wall = look(place.at, place.normal);
    (wall.slanted ? walls.slanted : walls.opposite).push_back(wall.thickness);
  }
  const std::size_t step = surface.triangles.size() / most_triangles + 1;
  for (std::size_t t = 0; t < surface.triangles.size(); t += step) {
    const auto [a, b, c] = surface.corners(t);
    const Vec3 normal = tree.normal(static_cast<std::uint32_t>(t));
    if (!(normal == Vec3{})) (void)look((1.0 / 3) * (a + b + c), normal);
  }
  std::ranges::sort(walls.opposite);
  std::ranges::sort(walls.slanted);
  return walls;
}

double Walls::share_thinner(double length) const {
  return n_places() > 0 ? count_thinner(opposite, length) / n_places() : 0;
}

double Walls::share_thinner_or_slanted(double length) const {
  const double n = count_thinner(opposite, length) + count_thinner(slanted, length);
  return n_places() > 0 ? n / n_places() : 0;
}

}  // namespace tess::dn
