// The step loop of a scene, composed at set-up: make_stepper() picks from a table of instantiated
// loops the one that holds this scene's rules and no test for the others. Serial; any thread may
// run any part of the particles, at the same time, with the same Stepper. The result depends on the
// particle, the objects, the time and the step alone: not on blocks, threads or instruction set.
//
// One step of a particle:
//     velocity   quadratic drags and the surface flow, each by its exact solution
//     flight     gravity, wind, linear drags and explosions, exact for constant coefficients, gives
//                the velocity at the end and the way
//     surface    the spring's exact motion along the normal; the impact at its time within the
//                step, then the rest of the step with the new velocity
#pragma once

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/frame.hpp"
#include "collide/dn_field/particles.hpp"
#include "collide/dn_field/rules.hpp"

#include <memory>
#include <span>

namespace tess::dn {

class Bvh;

/// What particles collide with. The field is shared, read-only, and must outlive the object.
struct Object {
  const Field* field = nullptr;
  Frame frame;  ///< at the start of a run, with the velocities it moves by
  /// If given, look-ups ask this, and `field` is what it was made from or its outline(). All
  /// objects of a scene have one or none has.
  const CompressedField* compressed = nullptr;
  /// If given, of the surface that the field was built from. With it, impacts let nobody through
  /// where two sheets of a two-sided field meet, which the field alone does.
  const Bvh* triangles = nullptr;
};

/// Moves all frames over n_steps; bit for bit what a run of n_steps sees.
void advance(std::span<Object> objects, double step, int n_steps);

/// Throws Error(bad_argument) where `objects` cannot serve `rules`: a field without distances or
/// without the normals that a rule needs, or thinner than a rule reaches; a scale that is not
/// positive and finite; compressed and flat fields together, or the trilinear look-up of compressed
/// ones.
void validate(const Rules& rules, std::span<const Object> objects);

/// Where the way of a fast particle bent in a step.
struct Waypoint {
  std::size_t particle = 0;
  double part = 0;  ///< of the step, that had gone by
  Vec3 place;
};

class Stepper {
 public:
  /// n_steps steps from `time` on, the objects standing as at `time`. Particles are taken a few
  /// hundred at a time through all the steps, so that they stay in the cache: many steps a call are
  /// faster than one. Particles that are not finite stay so and touch no others. `objects` must
  /// have passed validate().
  void run(ParticleSpan particles, std::span<const Object> objects, double time,
           int n_steps = 1) const;

  /// One such step. Tells the bounces, in the order of particles and of time, of those that went
  /// further than was known to be free; the others' ways are straight but for half a voxel.
  [[nodiscard]] std::vector<Waypoint> run_once(ParticleSpan particles,
                                               std::span<const Object> objects, double time) const;

  struct Plan;  ///< constants and loops of a scene; in step_plan.hpp

 private:
  friend Stepper make_stepper(const Rules& rules, double step);
  explicit Stepper(std::shared_ptr<const Plan> plan) : plan_(std::move(plan)) {}
  void run(ParticleSpan particles, std::span<const Object> objects, double time, int n_steps,
           std::vector<Waypoint>* waypoints) const;
  std::shared_ptr<const Plan> plan_;
};

/// Throws Error(bad_value) where validate(rules) does, and for a step that is not positive and
/// finite.
[[nodiscard]] Stepper make_stepper(const Rules& rules, double step);

/// Sum of v²/2. Particles that are not finite are left out.
[[nodiscard]] double kinetic_energy(ParticleSpan particles);

/// Particles with a coordinate or velocity that is NaN or infinite.
[[nodiscard]] std::size_t count_nonfinite(ParticleSpan particles);

}  // namespace tess::dn
