#include "collide/dn_field/rules/velocity_rules.hpp"

#include <algorithm>

namespace tess::dn {
using namespace lanes;

VelocityChanges velocity_changes(const Rules& rules, double time, double step) {
  VelocityChanges changes;
  for (const Explosion& explosion : rules.explosions) {
    const double active = std::min(time + step, explosion.start + explosion.duration) -
                          std::max(time, explosion.start);
    if (active > 0)
      changes.kicks.push_back(
          {explosion.centre, explosion.strength * active, 1 / explosion.radius});
  }
  if (rules.air_drag && rules.air_drag->law == DragLaw::quadratic)
    changes.drag = rules.air_drag->rate * step;
  return changes;
}

void change_velocities(const VelocityChanges& changes, const ParticleSpan& span) {
  const ParticleSpan particles = span;  // which no store can change
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D3 v = changed(changes, places(particles, p), velocities(particles, p));
    set_velocities(particles, p, v);
  }
}

void drag_quadratic(double rate_step, double threshold, Setting setting,
                    const ParticleSpan& particles, const Closest& closest) {
  for (std::size_t p = 0; p < particles.count; p += width) {
    const L near = to_double(load<F>(closest.distance + p)) < threshold;
    if (!any(near)) continue;
    D3 u{};
    if (setting == Setting::general) u = surface_velocities(closest, p);
    const D3 v = velocities(particles, p), w = v - u;
    set_velocities(particles, p, select(near, u + slowed(rate_step, w), v));
  }
}

void turn_to_surface(const FlowConstants& flow, Setting setting, const ParticleSpan& particles,
                     const Closest& closest) {
  if (setting == Setting::general)
    flow_loop<Setting::general>(flow, particles, closest);
  else
    flow_loop<Setting::one_at_rest>(flow, particles, closest);
}

}  // namespace tess::dn
