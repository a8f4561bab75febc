// Particles of one species, and what a run observes in them: sums and counts, positions of traced
// particles, and particles that went through a surface. No message is sent here.
#pragma once

#include "apps/particles/simulation/station.hpp"
#include "collide/dn_field/particles.hpp"

#include <cstdint>
#include <vector>

namespace particles {

/// With the id of each and whether it went through a surface. They are independent of one another;
/// their order has no meaning.
struct Flock {
  tess::dn::Particles motion;
  std::vector<std::uint64_t> ids;
  std::vector<std::uint8_t> tunnelled;  ///< 1: it went through a surface

  [[nodiscard]] std::size_t size() const { return ids.size(); }

  void add(std::uint64_t id, tess::dn::Vec3 position, tess::dn::Vec3 velocity,
           std::uint8_t has_tunnelled = 0) {
    motion.push_back(position, velocity);
    ids.push_back(id);
    tunnelled.push_back(has_tunnelled);
  }
  void add(const Flock& other, std::size_t p) {
    add(other.ids[p], other.motion.position(p), other.motion.velocity(p), other.tunnelled[p]);
  }
  /// Takes out particle p; the last one takes its place.
  void remove(std::size_t p) {
    const auto take = [p](auto&... columns) {
      ((columns[p] = columns.back(), columns.pop_back()), ...);
    };
    take(motion.x, motion.y, motion.z, motion.vx, motion.vy, motion.vz, ids, tunnelled);
  }
};

/// Adds the measures of particles of one mass, the objects standing as given.
void measure(const Stage& stage, const std::vector<tess::dn::Object>& objects, const Flock& flock,
             double mass, Measured& into);

/// Appends the traced particles of the flock.
void trace(const Stage& stage, const Flock& flock, std::vector<Sample>& into);

/// Marks particles whose last step, from `before` over `waypoints` to their position, went through
/// a surface of the objects, which stand as at the begin of the step.
void note_tunnelled(const Stage& stage, const std::vector<tess::dn::Object>& at_begin,
                    const tess::dn::Particles& before,
                    std::span<const tess::dn::Waypoint> waypoints, Flock& flock);

/// Marks particles that began outside of an object and now are deep below its surface. It misses
/// those that have left the object again, but costs nothing while steps run.
void note_inside(const Stage& stage, const std::vector<tess::dn::Object>& objects, Flock& flock);

}  // namespace particles
