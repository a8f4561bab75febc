#include "apps/particles/study/exact_bounce.hpp"

#include "collide/dn_field/surface.hpp"
#include "runtime/core/hash.hpp"

#include <cmath>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

struct Hit {
  double time = HUGE_VAL;
  Vec3 normal;
};

/// The first triangle on the way (Möller and Trumbore 1997). All are asked: this is the oracle.
Hit first_hit(const Surface& surface, Vec3 start, Vec3 along) {
  Hit first;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto [a, b, c] = surface.corners(i);
    const Vec3 ab = b - a, ac = c - a, h = cross(along, ac), s = start - a;
    const double determinant = dot(ab, h);
    if (determinant == 0) continue;
    const double u = dot(s, h) / determinant;
    if (u < 0 || u > 1) continue;
    const Vec3 q = cross(s, ab);
    const double v = dot(along, q) / determinant, time = dot(ac, q) / determinant;
    if (v < 0 || u + v > 1 || time <= 0 || time >= first.time) continue;
    first = {time, direction(cross(ab, ac))};
  }
  return first;
}

}  // namespace

std::vector<Bounce> exact_bounces(const Surface& surface, std::size_t n, double from,
                                  std::uint64_t seed) {
  constexpr double steepest = std::numbers::pi / 3;
  tess::Random random(seed);
  const std::vector<double> areas = area_sums(surface);
  std::vector<Bounce> bounces;
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
    const Hit hit = first_hit(surface, bounce.start, bounce.velocity);
    const double into = dot(hit.normal, bounce.velocity);
    if (!(hit.time < HUGE_VAL) || into >= 0) continue;
    bounce.time = hit.time;
    bounce.hit = bounce.start + hit.time * bounce.velocity;
    bounce.outgoing = bounce.velocity - (2 * into) * hit.normal;
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
