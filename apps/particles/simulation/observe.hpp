// What is looked at in a flock of particles: sums and counts, paths of traced particles, and who
// went through a surface. No message in it.
#pragma once

#include "apps/particles/audit/measured.hpp"
#include "apps/particles/simulation/flock.hpp"
#include "apps/particles/simulation/station.hpp"

#include <vector>

namespace particles {

/// Adds what the particles of a species show, the objects standing as given.
void measure(const Stage& stage, const std::vector<tess::dn::Object>& objects, const Flock& flock,
             std::size_t species, Measured& into);

/// Appends the traced particles of the flock.
void trace(const Stage& stage, const Flock& flock, std::vector<Sample>& into);

/// Whether the trajectories hold particle `id` of `n`: `traced` of them, evenly spread.
[[nodiscard]] bool is_traced(std::uint64_t id, std::uint64_t n, std::uint64_t traced);

/// Marks particles whose last step, from `before` over `waypoints` to where they are, went through
/// a surface of the objects, which are as when it began.
void note_tunnelled(const Stage& stage, const std::vector<tess::dn::Object>& at_begin,
                    const tess::dn::Particles& before,
                    std::span<const tess::dn::Waypoint> waypoints, Flock& flock);

/// Marks particles that began outside of an object and now are deep below its surface.
/// Fewer than note_tunnelled() finds, who looks at every step, but at no cost while steps run.
void note_inside(const Stage& stage, const std::vector<tess::dn::Object>& objects, Flock& flock);

}  // namespace particles
