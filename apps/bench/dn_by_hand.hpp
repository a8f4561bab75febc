// Single rules as one would write them by hand, without a stepper: what the composed loop is held
// against. A vector of particles at a time, in blocks that stay in the first cache, with nothing
// but the rule. All take n_steps steps.
#pragma once

#include "apps/bench/dn_scene.hpp"
#include "collide/dn_field/rules.hpp"

namespace bench {

/// Gravity alone: the parabola.
void gravity_by_hand(const tess::dn::ParticleSpan& all, tess::dn::Vec3 g);

/// Linear air drag alone.
void air_drag_by_hand(const tess::dn::ParticleSpan& all, double rate);

/// Nearest look-up of the distance and linear drag closer than `reach`.
void surface_drag_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Field& field,
                          double rate, double reach);

/// Nearest look-up and impact of restitution 1.
void impact_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Field& field);

/// One explosion that lasts.
void explosion_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Explosion& explosion);

/// Nearest look-up and the turn of velocities toward the tangent.
void flow_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Field& field,
                  const tess::dn::SurfaceFlow& flow);

/// Nearest look-up and a spring that a step is short against: the exact motion of who stays in
/// contact, and no more energy than there was where the field's distances jump.
void spring_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Field& field,
                    const tess::dn::Spring& spring);

}  // namespace bench
