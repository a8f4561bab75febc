// A block of particles taken through the next steps: who may feel a surface is packed and taken
// through them alone, the others fly free. Private to the step loop.
#pragma once

#include "collide/dn_field/step/moments.hpp"
#include "collide/dn_field/step/start.hpp"

namespace tess::dn {

/// What a block needs besides its particles; made once a run, used by one block after another.
class BlockFlight {
 public:
  explicit BlockFlight(bool keeps_waypoints);

  /// Through all steps of `moments`. block.count: whole vectors, block_size at most.
  void fly(const Run& run, const Moments& moments, const ParticleSpan& block);
  /// If kept: of the last fly(), which was one step, by particle and time.
  [[nodiscard]] const std::vector<Waypoint>& waypoints() const { return scratch_.waypoints; }

 private:
  void new_particles(std::size_t count);
  void number_in_block();
  void look_up_all(const Run& run, std::span<const Placed> objects, const ParticleSpan& particles,
                   Closest& closest) const;
  void meet_surface(const Run& run, const Moments& moments, int step,
                    const ParticleSpan& particles);
  void step_near(const Run& run, const Moments& moments, int step, const ParticleSpan& particles);
  /// Lists who of `particles` may be near in the steps from `from` on, before `to`; whether it pays
  /// to take them apart.
  [[nodiscard]] bool screen_for(const Run& run, const Moments& moments, int from, int to,
                                const ParticleSpan& particles);

  Closest first_, second_;
  Closest *closest_ = &first_, *after_ = &second_;  // at the step's start and end
  bool known_ = false;                              // closest_ is up to date
  Near near_;
  bool screening_paid_ = true;  // the last time, whichever block it was
  bool keeps_waypoints_;
  Scratch scratch_;
  Start start_;
};

}  // namespace tess::dn
