// Particles of one species, with the id of each and whether it went through a surface. They are
// independent of one another; their order has no meaning.
#pragma once

#include "collide/dn_field/particles.hpp"

#include <cstdint>
#include <vector>

namespace particles {

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

}  // namespace particles
