// The rules that change nothing but the velocity, each a loop of its own over a block, before the
// rule loop: explosions, quadratic drags and the surface flow. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/flow_lanes.hpp"
#include "collide/dn_field/rules/velocity_lanes.hpp"

namespace tess::dn {

/// The rules' part in [time, time + step].
[[nodiscard]] VelocityChanges velocity_changes(const Rules& rules, double time, double step);
void change_velocities(const VelocityChanges& changes, const ParticleSpan& particles);

/// Quadratic drag in distance < threshold, toward the surface's velocity.
void drag_quadratic(double rate_step, double threshold, Setting setting,
                    const ParticleSpan& particles, const Closest& closest);

/// The surface flow of the particles in its reach.
void turn_to_surface(const FlowConstants& flow, Setting setting, const ParticleSpan& particles,
                     const Closest& closest);

}  // namespace tess::dn
