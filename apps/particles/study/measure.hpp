// What the study measures of one choice: a field against exact distances and normals, bounces
// against exact ones, and time. Serial; private to the study.
#pragma once

#include "apps/particles/study/exact_bounce.hpp"
#include "apps/particles/study/study.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/stepper.hpp"

#include <functional>
#include <vector>

namespace particles {

/// The object, and what is exact about it.
struct Subject {
  const SceneObject& object;
  tess::dn::Bvh tree;
  std::vector<Bounce> bounces;
  double thickness;
};

/// Points around the surface whose closest point is in the midst of a triangle: off the medial
/// axis, where the distance is smooth.
struct Samples {
  std::vector<float> x, y, z;
  std::vector<double> distance;
  std::vector<tess::dn::Vec3> normal;
};

[[nodiscard]] Samples samples_of(const Subject& subject, std::size_t n);

/// A look-up: fills in the answers for the points.
using Ask = std::function<void(const tess::dn::Points&, const tess::dn::Answers&)>;

/// Errors of distance and normal.
void compare(const Ask& ask, const Samples& samples, StudyRow& row);

/// Lets all bounces happen step by step, and compares each with the exact one.
void bounce(const tess::dn::Object& object, const tess::dn::Rules& rules, double dt,
            const Subject& subject, StudyRow& row);

/// Particles near the surface with velocities of 1 in all directions.
[[nodiscard]] tess::dn::Particles crowd(const Subject& subject, std::size_t n);

/// Nanoseconds a particle and step of a crowd of n; `object` may be null. Fastest of three, of
/// steps so short that the crowd stays where it is.
[[nodiscard]] double ns_of(const tess::dn::Object* object, const tess::dn::Rules& rules,
                           const Subject& subject, std::size_t n);

/// The same of one step of `dt`, from one crowd each time.
[[nodiscard]] double ns_of_step(const tess::dn::Object& object, const tess::dn::Rules& rules,
                                double dt, const Subject& subject, std::size_t n);

/// The fastest of three.
[[nodiscard]] double fastest_seconds(const std::function<void()>& work);

}  // namespace particles
