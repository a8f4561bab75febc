#include "collide/dn_field/velocity_rules.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

using namespace lanes;

D3 velocities(const ParticleSpan& particles, std::size_t p) {
  return {load<D>(particles.vx + p), load<D>(particles.vy + p), load<D>(particles.vz + p)};
}
void set_velocities(const ParticleSpan& particles, std::size_t p, D3 v) {
  store(particles.vx + p, v.x), store(particles.vy + p, v.y), store(particles.vz + p, v.z);
}

}  // namespace

void explode(const Explosion& explosion, double active, const ParticleSpan& span) {
  const ParticleSpan particles = span;  // which no store can change
  const Vec3 c = explosion.centre;
  const auto kick = static_cast<float>(explosion.strength * active),
             per_radius = static_cast<float>(1 / explosion.radius);
  for (std::size_t p = 0; p < particles.count; p += width) {
    // Seven digits are enough for a kick; the velocity keeps its own.
    const F3 from{to_float(load<D>(particles.x + p) - c.x),
                  to_float(load<D>(particles.y + p) - c.y),
                  to_float(load<D>(particles.z + p) - c.z)};
    const F per_r = 1.0F / sqrt(dot(from, from));
    const I reached = (per_r > per_radius) & (per_r < HUGE_VALF);  // the centre has no direction
    if (!any(reached)) continue;
    const F3 pushed = (kick * (per_r - per_radius)) * from;
    const F none = all(-0.0F);  // leaves every number its bits, zeros too
    const F3 added = select(reached, pushed, F3{none, none, none});
    set_velocities(particles, p, velocities(particles, p) + to_double(added));
  }
}

void drag_quadratic(double rate_step, const ParticleSpan& particles) {
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D3 v = velocities(particles, p);
    set_velocities(particles, p, (1.0 / (1.0 + rate_step * sqrt(dot(v, v)))) * v);
  }
}

void drag_quadratic(double rate_step,
                    double threshold,
                    Setting setting,
                    const ParticleSpan& particles,
                    const Closest& closest) {
  for (std::size_t p = 0; p < particles.count; p += width) {
    const L near = to_double(load<F>(closest.distance + p)) < threshold;
    if (!any(near)) continue;
    D3 u{};
    if (setting == Setting::general)
      u = {load<D>(closest.ux + p), load<D>(closest.uy + p), load<D>(closest.uz + p)};
    const D3 v = velocities(particles, p), w = v - u;
    const D3 slowed = u + (1.0 / (1.0 + rate_step * sqrt(dot(w, w)))) * w;
    set_velocities(particles, p, select(near, slowed, v));
  }
}

void turn_to_surface(const FlowConstants& flow,
                     Setting setting,
                     const ParticleSpan& particles,
                     const Closest& closest) {
  if (setting == Setting::general)
    flow_loop<Setting::general>(flow, particles, closest);
  else
    flow_loop<Setting::one_at_rest>(flow, particles, closest);
}

double active_within(const Explosion& explosion, double time, double step) {
  return std::max(0.0,
                  std::min(time + step, explosion.start + explosion.duration) -
                      std::max(time, explosion.start));
}

}  // namespace tess::dn
