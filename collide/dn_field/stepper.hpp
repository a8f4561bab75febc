// The step loop of a scene: make_stepper() picks the loop that holds this scene's rules and no test
// for the others. Any number of threads may use one Stepper for different particles at the same
// time. The result depends only on the particle, the objects, the time and the step: not on blocks,
// threads or instruction set. README.md shows a step as a picture.
//
// Limits: a voxel stores one surface. In a corner of two objects a particle may enter the further
// one by half a cell, and where open surfaces meet it may pass the joint. Where a stiff spring
// catches it from the side, a particle turns back the way it came instead of being reflected. An
// open surface that turns by a radian a step may pass particles that a spring and its drag hold.
#pragma once

#include "collide/dn_field/frame.hpp"
#include "collide/dn_field/particles.hpp"
#include "collide/dn_field/rules.hpp"

#include <memory>
#include <span>

namespace tess::dn {

/// An obstacle. The field is shared, read-only, and must outlive the object. Either all fields of a
/// scene are compressed or none is.
struct Object {
  const Field* field = nullptr;
  Frame frame;  ///< at the start of a run, with its velocities
};

/// Moves all frames over n_steps, to the bit as a run of n_steps does.
void advance(std::span<Object> objects, double step, int n_steps);

/// Throws Error(bad_argument) if `objects` do not fit `rules`: a field without distances or without
/// the normals that a rule needs, or thinner than a rule reaches; a scale that is not positive and
/// finite; compressed and flat fields together, or trilinear samples of compressed ones.
void validate(const Rules& rules, std::span<const Object> objects);

/// A bend in the path of a traced particle.
struct Waypoint {
  std::size_t particle = 0;
  double part = 0;  ///< fraction of the step
  Vec3 place;
};

class Stepper {
 public:
  /// Runs n_steps steps from `time` on; `objects` are those at `time` and have passed validate().
  /// A block of particles goes through all steps while it is in the cache, so many steps per call
  /// are faster than one. A particle that is not finite stays so and affects no other.
  void run(ParticleSpan particles, std::span<const Object> objects, double time,
           int n_steps = 1) const;

  /// Runs one step and returns the waypoints of traced particles, in the order of particles and of
  /// time. The paths of all others are straight up to half a voxel.
  [[nodiscard]] std::vector<Waypoint> run_once(ParticleSpan particles,
                                               std::span<const Object> objects, double time) const;

  struct Plan;  ///< see step/object_poses.hpp

 private:
  friend Stepper make_stepper(const Rules& rules, double step);
  explicit Stepper(std::shared_ptr<const Plan> plan) : plan_(std::move(plan)) {}
  void run(ParticleSpan particles, std::span<const Object> objects, double time, int n_steps,
           std::vector<Waypoint>* waypoints) const;
  std::shared_ptr<const Plan> plan_;
};

/// Throws Error(bad_value) where validate(rules) does, or if the step is not positive and finite.
[[nodiscard]] Stepper make_stepper(const Rules& rules, double step);

}  // namespace tess::dn
