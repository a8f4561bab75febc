#include "apps/particles/study/exact_flight.hpp"

#include <algorithm>
#include <cmath>

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

Flight exact_drag(const Bvh& tree, const Flight& start, const SurfaceDrag& drag, double time) {
  const Vec3 along = direction(start.velocity);
  const double shortest = 1e-9 * drag.threshold;
  double way = 0, speed = norm(start.velocity);
  while (time > 0 && speed > 0) {
    const double distance = std::sqrt(tree.closest(start.position + way * along).distance2);
    // The distance changes by no more than the way: until there the drag acts or does not.
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
