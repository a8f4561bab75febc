// A block of particles taken through the next steps. Particles that may feel a surface are packed
// together for the rules of the surface; the others fly free. Private to the step loop.
#pragma once

#include "collide/dn_field/step/culling.hpp"
#include "collide/dn_field/step/object_poses.hpp"

namespace tess::dn {

/// The scratch memory of a run; its blocks use it one after the other.
class BlockFlight {
 public:
  explicit BlockFlight(bool keeps_waypoints);

  /// Takes a block through all steps of `poses`. block.count: whole vectors, at most block_size.
  void fly(const Run& run, const ObjectPoses& poses, const ParticleSpan& block);
  /// Of the last fly(), which was one step, by particle and time; empty if not kept.
  [[nodiscard]] const std::vector<Waypoint>& waypoints() const { return scratch_.waypoints; }

 private:
  void new_particles(std::size_t count);
  void sample_all(const Run& run, std::span<const PlacedObject> objects,
                  const ParticleSpan& particles, NearestSurface& nearest) const;
  [[nodiscard]] bool limit_springs(const Run& run, const ParticleSpan& particles);
  void meet_surface(const Run& run, const ObjectPoses& poses, int step,
                    const ParticleSpan& particles);
  void step_near(const Run& run, const ObjectPoses& poses, int step, const ParticleSpan& particles);
  [[nodiscard]] bool cull_for(const Run& run, const ObjectPoses& poses, int from, int to,
                              const ParticleSpan& particles);

  NearestSurface first_, second_;
  NearestSurface *nearest_ = &first_, *after_ = &second_;  // at the step's start and end
  bool up_to_date_ = false;                                // nearest_ is of this step
  NearParticles near_;
  bool culling_paid_ = true;  // the last time, for whichever block
  bool keeps_waypoints_;
  Scratch scratch_;
  ParticleRoom start_;  // the particles before the rules of the surface
};

}  // namespace tess::dn
