#include "apps/particles/study/exact.hpp"

#include "collide/dn_field/surface.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

/// `v` turned towards the tangent of the surface with this normal, by `angle` or what is left.
Vec3 turned_to_tangent(Vec3 v, Vec3 normal, double angle) {
  const double out = dot(normal, v), speed = norm(v);
  const Vec3 along = direction(v - out * normal);
  if (!(speed > 0) || along == Vec3{}) return v;
  const double left = std::asin(std::clamp(std::abs(out) / speed, 0.0, 1.0));
  const double to = left - std::min(angle, left);
  return speed * (std::cos(to) * along + std::copysign(std::sin(to), out) * normal);
}

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

Flight exact_drag(const Bvh& tree, const Flight& start, const SurfaceDrag& drag, double time) {
  const Vec3 along = direction(start.velocity);
  const double shortest = 1e-9 * drag.threshold;
  double way = 0, speed = norm(start.velocity);
  while (time > 0 && speed > 0) {
    const double distance = std::sqrt(tree.closest(start.position + way * along).distance2);
    // The distance changes by no more than the way: the drag acts on the whole piece, or not at
    // all.
    const double piece = std::max(std::abs(distance - drag.threshold), shortest);
    if (!(distance < drag.threshold)) {
      const double took = std::min(time, piece / speed);
      way += took * speed;
      time -= took;
      continue;
    }
    const double whole = speed / drag.rate;  // the way until it rests
    const double took = piece < whole ? -std::log1p(-piece / whole) / drag.rate : HUGE_VAL;
    const double now = std::min(time, took);
    way += -std::expm1(-drag.rate * now) * whole;
    speed *= std::exp(-drag.rate * now);
    time -= now;
  }
  return {start.position + way * along, speed * along};
}

Flight exact_flow(const Bvh& tree, const Flight& start, const SurfaceFlow& flow, double time,
                  int n_steps) {
  Flight now = start;
  const double step = time / n_steps;
  for (int i = 0; i < n_steps; ++i) {
    const Vec3 midway = now.position + 0.5 * step * now.velocity;
    const ClosestPoint closest = tree.closest(midway);
    const Vec3 before = now.velocity, normal = direction(midway - closest.point);
    if (closest.distance2 < flow.distance * flow.distance) {
      const double alpha = dot(normal, before) < 0 ? flow.alpha_in : flow.alpha_out;
      now.velocity = turned_to_tangent(before, normal, alpha * step / norm(before));
    }
    now.position += 0.5 * step * (before + now.velocity);
  }
  return now;
}

}  // namespace particles
