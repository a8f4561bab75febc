// Single rules as one would write them by hand, without a stepper: what the composed loop is held
// against. A vector of particles at a time, in blocks that stay in the first cache, with nothing
// but the rule. All take n_steps steps.
#pragma once

#include "apps/bench/dn_scene.hpp"

namespace bench {

/// Gravity alone: the parabola.
void gravity_by_hand(const tess::dn::ParticleSpan& all, tess::dn::Vec3 g);

/// Linear air drag alone.
void air_drag_by_hand(const tess::dn::ParticleSpan& all, double rate);

/// Nearest look-up of the distance and linear drag closer than `reach`.
void surface_drag_by_hand(const tess::dn::ParticleSpan& all,
                          const tess::dn::Field& field,
                          double rate,
                          double reach);

/// Nearest look-up and impact of restitution 1.
void impact_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Field& field);

}  // namespace bench
