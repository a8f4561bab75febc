#include "apps/particles/study/exact.hpp"

#include "collide/dn_field/surface.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;
}  // namespace

std::vector<Bounce> exact_bounces(const Surface& surface, const Bvh& tree, std::size_t n,
                                  double from, std::uint64_t seed) {
  constexpr double steepest = std::numbers::pi / 3;
  tess::Random random(seed);
  const std::vector<double> areas = area_sums(surface);
  std::vector<Bounce> bounces;
  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i < n; ++i) {
    const double first = random.unit(), second = random.unit(), third = random.unit();
    const auto [point, normal, triangle] = point_on(surface, areas, first, second, third);
    const auto [a, b, c] = surface.corners(triangle);
    const Vec3 side = direction(b - a), other = cross(normal, side);
    const double tilt = steepest * random.unit(), turn = 2 * std::numbers::pi * random.unit();
    const Vec3 out =
        std::cos(tilt) * normal + std::sin(tilt) * (std::cos(turn) * side + std::sin(turn) * other);
    Bounce bounce;
    bounce.start = point + (from / std::cos(tilt)) * out;
    bounce.velocity = -out;
    const double reach = 2 * from / std::cos(tilt);
    crossings.clear();
    tree.crossings(bounce.start, bounce.start + reach * bounce.velocity, crossings);
    if (crossings.empty()) continue;
    const Crossing hit = *std::ranges::min_element(crossings, {}, &Crossing::at);
    const Vec3 met = tree.normal(hit.triangle);
    const double into = dot(met, bounce.velocity);
    if (into >= 0) continue;
    bounce.time = hit.at * reach;
    bounce.hit = bounce.start + bounce.time * bounce.velocity;
    bounce.outgoing = bounce.velocity - (2 * into) * met;
    bounces.push_back(bounce);
  }
  return bounces;
}

double bounce_time(const Bounce& bounce, Vec3 place, Vec3 velocity, double time) {
  const Vec3 change = bounce.velocity - velocity;
  const double size2 = dot(change, change);
  return size2 > 0 ? dot(place - bounce.start - time * velocity, change) / size2 : time;
}

}  // namespace particles
