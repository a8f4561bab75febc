#include "collide/dn_field/step/corrections.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

using namespace lanes;

constexpr double noise = 1e-6;  // of the energy: the rounding of float distances

void erase_waypoints(const CorrectedStep& step, std::size_t p, L which) {
  std::erase_if(step.scratch.waypoints, [&](const Waypoint& bend) {
    return bend.particle - p < width && which[bend.particle - p] != 0;
  });
}

}  // namespace

bool limit_springs(const CorrectedStep& step, const NearestSurface& nearest_after) {
  const SpringConstants spring = step.constants.spring;  // copies that no store can change
  const ParticleSpan particles = step.particles;
  bool returned = false;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D depth = spring.reach - to_double(load<F>(nearest_after.distance + p));
    D3 u{};
    if (step.setting == Setting::general) u = surface_velocities(step.nearest, p);
    const D3 v = velocities(particles, p), w = v - u;
    const D kinetic = dot(w, w), had = max(load<D>(step.scratch.energy + p), D{}),
            left = had - spring.stiffness * depth * depth;
    const L over = (depth > 0.0) & (kinetic - left > noise * had) & (kinetic < HUGE_VAL);
    if (!any(over)) continue;
    const L slows = over & (left > 0.0), returns = over & ~slows;
    set_velocities(particles, p, select(slows, u + sqrt(only(slows, left / kinetic)) * w, v));
    if (!any(returns)) continue;
    returned = true;
    const D3 back = fma(all(step.constants.step), u, places(step.start, p)),
             turned = u + (u - velocities(step.start, p));
    set_places(particles, p, select(returns, back, places(particles, p)));
    set_velocities(particles, p, select(returns, turned, velocities(particles, p)));
    erase_waypoints(step, p, returns);
  }
  return returned;
}

}  // namespace tess::dn
