// What the study measures of one choice: a field against exact distances and normals, bounces
// against exact ones off the triangles, flights against those of short steps, and time. Serial;
// private to the study.
#pragma once

#include "apps/particles/study/study.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/stepper.hpp"

#include <cstdint>
#include <functional>
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

/// The object and its exact reference.
struct Subject {
  SceneObject object;
  tess::dn::Bvh tree;
  std::vector<Bounce> bounces;
  double thickness;
};

/// Points around the surface whose closest point is inside a triangle, not on an edge: off the
/// medial axis, where the distance is smooth.
struct Samples {
  std::vector<float> x, y, z;
  std::vector<double> distance;
  std::vector<tess::dn::Vec3> normal;
};
[[nodiscard]] Samples samples_of(const Subject& subject, std::size_t n);

/// Errors of distance and normal.
void compare(const tess::dn::Field& field, tess::dn::LookUp kind, const Samples& samples,
             StudyRow& row);

/// Moves the particles of all bounces step by step, and compares each with the exact bounce.
void compare_bounces(const tess::dn::Object& object, const tess::dn::Rules& rules, double dt,
                     const Subject& subject, StudyRow& row);

/// Particles after `time` in steps of dt.
[[nodiscard]] tess::dn::Particles flown(const tess::dn::Object& object,
                                        const tess::dn::Rules& rules, double dt, double time,
                                        const tess::dn::Particles& starts);

/// Errors of places and directions.
void compare_flights(const tess::dn::Particles& found, const tess::dn::Particles& wanted,
                     StudyRow& row);

/// Particles near the surface with velocities of 1 in all directions.
[[nodiscard]] tess::dn::Particles crowd(const Subject& subject, std::size_t n);

/// Seconds of this thread: wall clock, and CPU time, which does not count other work on the core.
struct Cost {
  double wall = HUGE_VAL, cpu = HUGE_VAL;
};
/// The least of each over five runs of the work; over fewer, but one at least, where the runs take
/// more than a second together. `prepare` is not timed.
[[nodiscard]] Cost least_cost(
    const std::function<void()>& work, const std::function<void()>& prepare = [] {});

/// Sets the times in nanoseconds per piece of work; the work had `n` of them.
void set_times(StudyRow& row, const Cost& cost, double n);

/// Times n_steps steps of dt of a crowd of `n` in one call; `object` may be null.
void time_steps(const tess::dn::Object* object, const tess::dn::Rules& rules, double dt,
                int n_steps, const Subject& subject, std::size_t n, StudyRow& row);

}  // namespace particles
