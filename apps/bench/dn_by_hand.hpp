// Single rules as one would write them by hand, without a stepper: what the composed loop is held
// against. All take n_steps steps.
#pragma once

#include "apps/bench/dn_scene.hpp"

namespace bench {

/// Gravity alone: the parabola.
void gravity_by_hand(const tess::dn::ParticleSpan& all, tess::dn::Vec3 g);

/// Nearest look-up and impact of restitution 1.
void impact_by_hand(const tess::dn::ParticleSpan& all, const tess::dn::Field& field);

}  // namespace bench
