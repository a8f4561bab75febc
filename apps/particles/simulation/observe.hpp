// What a run observes in a flock: sums and counts, positions of traced particles, and particles
// that went through a surface. No message is sent here.
#pragma once

#include "apps/particles/audit/measured.hpp"
#include "apps/particles/simulation/flock.hpp"
#include "apps/particles/simulation/station.hpp"

#include <vector>

namespace particles {

/// Adds the measures of particles of one mass, the objects standing as given.
void measure(const Stage& stage, const std::vector<tess::dn::Object>& objects, const Flock& flock,
             double mass, Measured& into);

/// Appends the traced particles of the flock.
void trace(const Stage& stage, const Flock& flock, std::vector<Sample>& into);

/// Marks particles whose last step, from `before` over `waypoints` to their position, went through
/// a surface of the objects, which stand as at the begin of the step.
void note_tunnelled(const Stage& stage, const std::vector<tess::dn::Object>& at_begin,
                    const tess::dn::Particles& before,
                    std::span<const tess::dn::Waypoint> waypoints, Flock& flock);

/// Marks particles that began outside of an object and now are deep below its surface. It misses
/// those that have left the object again, but costs nothing while steps run.
void note_inside(const Stage& stage, const std::vector<tess::dn::Object>& objects, Flock& flock);

}  // namespace particles
