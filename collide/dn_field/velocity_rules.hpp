// The rules that change nothing but the velocity, each a loop of its own over a block, before the
// rule loop: explosions, quadratic drags and the surface flow. Private to the step loop.
#pragma once

#include "collide/dn_field/flow_lanes.hpp"

namespace tess::dn {

/// The kick of an explosion over `active` seconds.
void explode(const Explosion& explosion, double active, const ParticleSpan& particles);

/// v / (1 + rate |v| step), the exact solution of v' = -rate |v| v.
void drag_quadratic(double rate_step, const ParticleSpan& particles);

/// The same in distance < threshold, toward the surface's velocity.
void drag_quadratic(double rate_step,
                    double threshold,
                    Setting setting,
                    const ParticleSpan& particles,
                    const Closest& closest);

/// The surface flow of the particles in its reach.
void turn_to_surface(const FlowConstants& flow,
                     Setting setting,
                     const ParticleSpan& particles,
                     const Closest& closest);

/// How much of [time, time + step] the explosion lasts.
[[nodiscard]] double active_within(const Explosion& explosion, double time, double step);

}  // namespace tess::dn
