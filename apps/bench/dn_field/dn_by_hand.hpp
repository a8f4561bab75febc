// Single rules written by hand without a stepper, for comparison with the composed loop. A loop
// takes a vector of particles at a time, in blocks that stay in the first-level cache, with only
// the rule. All take n_steps steps.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/particles.hpp"
#include "collide/dn_field/rules.hpp"

namespace bench {

inline constexpr double step = 1e-3;
inline constexpr int n_steps = 32;

/// Only gravity: the parabola.
void gravity_by_hand(const tess::dn::ParticleSpan& all, tess::dn::Vec3 g);

/// Only linear air drag.
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

/// Nearest lookup and a spring that is soft relative to the step: the exact motion of particles
/// that stay in contact, without energy gain where the field's distances jump.
void spring_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Field& field,
                    const tess::dn::Spring& spring);

}  // namespace bench
