#include "collide/dn_field/rules/surface_velocity.hpp"

#include "collide/dn_field/rules/flight.hpp"

namespace tess::dn {
using namespace lanes;

void drag_quadratic(double rate_time, double threshold, Setting setting,
                    const ParticleSpan& particles, const NearestSurface& nearest) {
  for (std::size_t p = 0; p < particles.count; p += width) {
    const L near = to_double(load<F>(nearest.distance + p)) < threshold;
    if (!any(near)) continue;
    D3 u{};
    if (setting == Setting::general) u = surface_velocities(nearest, p);
    const D3 v = velocities(particles, p), w = v - u;
    set_velocities(particles, p, select(near, u + slowed(rate_time, w), v));
  }
}

void turn_to_surface(const FlowConstants& flow, Setting setting, const ParticleSpan& particles,
                     const NearestSurface& nearest) {
  if (setting == Setting::general)
    flow_loop<Setting::general>(flow, particles, nearest);
  else
    flow_loop<Setting::one_at_rest>(flow, particles, nearest);
}

}  // namespace tess::dn
