// The flight of one particle that goes further in a step than is known to be free: sphere tracing.
// It advances by no more than the distance to the closest surface, so that it cannot pass one at
// any speed while the distance changes by at most one per unit of way. Scalar: few particles of a
// scene need it. Private to the step loop.
#pragma once

#include "collide/dn_field/rule_loop.hpp"

#include <span>

namespace tess::dn {

/// Flies `from` through the step, with up to 16 bounces, and writes its particle. What has more
/// bounces, in a crevice, stops at the last one until the next step. Returns twice the work that
/// the flight's acceleration did beyond that on the straight way.
double trace(const RuleConstants& constants,
             std::span<const Placed> objects,
             LookUp kind,
             const Untraced& from,
             const ParticleSpan& particles);

}  // namespace tess::dn
