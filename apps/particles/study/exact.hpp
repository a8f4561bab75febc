// The reference of the study: what particles do at the triangles themselves, without a field.
// Straight flight, reflection at the first triangle, straight flight: closed forms.
#pragma once

#include "collide/dn_field/bvh.hpp"

#include <cstdint>
#include <vector>

namespace particles {

/// A particle that is about to bounce, and where and how it does.
struct Bounce {
  tess::dn::Vec3 start, velocity;  ///< of speed 1
  double time = 0;                 ///< of the bounce
  tess::dn::Vec3 hit;              ///< its place
  tess::dn::Vec3 outgoing;         ///< the velocity after it, for restitution 1

  /// Out of the surface.
  [[nodiscard]] tess::dn::Vec3 normal() const { return direction(outgoing - velocity); }
};

/// Up to `n` bounces off a surface, of which `tree` holds the triangles: at points spread over its
/// area, approached from the distance `from` at up to 60 degrees off the normal. A path that meets
/// another front side first bounces there; one that meets a back side first is left out.
[[nodiscard]] std::vector<Bounce> exact_bounces(const tess::dn::Surface& surface,
                                                const tess::dn::Bvh& tree, std::size_t n,
                                                double from, std::uint64_t seed);

/// The time of a bounce from its two straight paths: begun at bounce.start, ended at `place` with
/// `velocity` after `time`. It is the time at which the paths come closest.
[[nodiscard]] double bounce_time(const Bounce& bounce, tess::dn::Vec3 place,
                                 tess::dn::Vec3 velocity, double time);

}  // namespace particles
