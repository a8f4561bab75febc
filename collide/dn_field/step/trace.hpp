// The flight of particles that go further in a step than is known to be free: sphere tracing. They
// advance by no more than the distance to the closest surface, so that they cannot pass one at any
// speed while the distance changes by at most one per unit of way. A vector of them at a time, each
// as if it were alone. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"

#include <span>

namespace tess::dn {

/// Flies each of `scratch.untraced` through the step, with up to 16 bounces, and writes its
/// particle. What has more bounces, in a crevice, is taken along by the last surface until the next
/// step. Adds to scratch.energy[particle] twice the work that the flight's acceleration did beyond
/// that on the straight way, and writes waypoints where they are kept.
void trace(const RuleConstants& constants, std::span<const Placed> objects, LookUp kind,
           const ParticleSpan& particles, Scratch& scratch);

}  // namespace tess::dn
