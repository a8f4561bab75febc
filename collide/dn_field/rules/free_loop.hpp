// Particles that feel no surface, several steps at once. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/flight_lanes.hpp"
#include "collide/dn_field/rules/particle_lanes.hpp"
#include "collide/dn_field/rules/velocity_lanes.hpp"

#include <span>

namespace tess::dn {

/// As many steps as `changes` has. Where it has nothing to say, each vector of particles is taken
/// through all of them without a store between.
using FreeLoop = void (*)(const FlightConstants&, const ParticleSpan&,
                          std::span<const VelocityChanges> changes);

/// Of particles that fly as `flight` says, but far from all surfaces.
[[nodiscard]] FreeLoop free_loop(Flight flight);

}  // namespace tess::dn
