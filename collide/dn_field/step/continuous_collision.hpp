// Continuous collision of the particles that move further in a step than is known to be free, by
// sphere tracing: a particle advances by at most the distance to the nearest surface, so that it
// passes none at any speed as long as the distance changes by at most one per unit length. A vector
// of particles is traced at a time; their results are independent. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"

namespace tess::dn {

/// Takes each particle of `scratch.untraced` through the step, with at most 16 bounces: a particle
/// with more of them, in a crevice, moves with the last surface until the next step. Adds to
/// scratch.energy[particle] twice the acceleration's work on the difference from the straight path,
/// and writes waypoints if they are kept.
void trace(const RuleConstants& constants, std::span<const PlacedObject> objects, LookUp kind,
           const ParticleSpan& particles, Scratch& scratch);

}  // namespace tess::dn
