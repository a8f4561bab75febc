// What the study measures of one choice: a field against exact distances and normals, bounces
// against exact ones, flights against those of short steps, and time. Serial; private to the study.
#pragma once

#include "apps/particles/study/exact.hpp"
#include "apps/particles/study/study.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/stepper.hpp"

#include <functional>
#include <vector>

namespace particles {

/// The object and its exact reference.
struct Subject {
  const SceneObject& object;
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
