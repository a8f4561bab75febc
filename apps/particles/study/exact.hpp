// The reference of the study: what particles do at the triangles themselves, without a field.
//
// Bounces: straight flight, reflection at the first triangle, straight flight; closed forms.
// Flights in front of the triangles, for rules that act at a distance: linear drag takes as much
// speed per length as its rate, a closed form between the places where its reach begins and ends,
// which exact distances give; surface flow is followed in short steps of second order with exact
// normals.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/rules.hpp"

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

struct Flight {
  tess::dn::Vec3 position, velocity;
};

/// After `time`, slowed down by the drag, which is linear, nearer than its threshold.
[[nodiscard]] Flight exact_drag(const tess::dn::Bvh& tree, const Flight& start,
                                const tess::dn::SurfaceDrag& drag, double time);

/// After `time`, turned by the flow; the error falls with the square of n_steps.
[[nodiscard]] Flight exact_flow(const tess::dn::Bvh& tree, const Flight& start,
                                const tess::dn::SurfaceFlow& flow, double time, int n_steps);

}  // namespace particles
