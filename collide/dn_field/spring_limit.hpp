// What keeps the spring passive where the closest surface changes within a step: in corners, past
// edges, on curved objects a particle can enter a stiff spring from the side, unnoticed by the
// plane that the step was computed with, and would find potential energy that it never paid for.
// After the step its depth is looked up again, and its speed, then its depth, cut to the energy it
// had. Private to the step loop.
#pragma once

#include "collide/dn_field/rule_loop.hpp"

namespace tess::dn {

/// Whether a particle was put elsewhere.
enum class Moved : std::uint32_t { none, some };

/// before, after: the closest surfaces at the step's start and end; scratch.energy: twice the
/// energy of each particle, spring and way included, as the rule loop left it.
Moved limit_spring(const SpringConstants& spring,
                   Setting setting,
                   const ParticleSpan& particles,
                   const Closest& before,
                   const Closest& after,
                   const Scratch& scratch);

}  // namespace tess::dn
