// The reference of the study: bounces off the triangles themselves. A particle flies straight, the
// first triangle on its way reflects it, and the rest is straight again: closed forms, no field.
#pragma once

#include "collide/dn_field/surface.hpp"

#include <cstdint>
#include <vector>

namespace particles {

/// A particle that is about to bounce, and where and how it does.
struct Bounce {
  tess::dn::Vec3 start, velocity;  ///< of speed 1
  double time = 0;                 ///< of the bounce
  tess::dn::Vec3 hit;              ///< its place
  tess::dn::Vec3 outgoing;         ///< the velocity after it, for restitution 1
};

/// `n` bounces off a surface: points spread over its area, each approached from the distance
/// `from` at up to 60 degrees off the normal, in one way for a seed. A way that meets another
/// triangle on the front side first bounces there; those that come from behind are left out, so
/// there may be fewer than n.
[[nodiscard]] std::vector<Bounce> exact_bounces(const tess::dn::Surface& surface, std::size_t n,
                                                double from, std::uint64_t seed);

/// Where a bounce happened, by its two straight ways: begun at start, ended at `place` with
/// `velocity` after `time`. The time at which the ways come closest.
[[nodiscard]] double bounce_time(const Bounce& bounce, tess::dn::Vec3 place,
                                 tess::dn::Vec3 velocity, double time);

}  // namespace particles
