// Particles of one species, with the id and the audit's mark of each. They are independent of one
// another; their order has no meaning.
#pragma once

#include "apps/particles/audit/passage.hpp"
#include "collide/dn_field/particles.hpp"

#include <cstdint>
#include <vector>

namespace particles {

struct Flock {
  tess::dn::Particles motion;
  std::vector<std::uint64_t> ids;
  std::vector<Mark> marks;  ///< for the audit

  [[nodiscard]] std::size_t size() const { return ids.size(); }

  void add(std::uint64_t id, tess::dn::Vec3 position, tess::dn::Vec3 velocity, Mark mark) {
    motion.push_back(position, velocity);
    ids.push_back(id);
    marks.push_back(mark);
  }
  void add(const Flock& other, std::size_t p) {
    add(other.ids[p], other.motion.position(p), other.motion.velocity(p), other.marks[p]);
  }
  /// Takes out particle p; the last one takes its place.
  void remove(std::size_t p) {
    const auto take = [p](auto&... columns) {
      ((columns[p] = columns.back(), columns.pop_back()), ...);
    };
    take(motion.x, motion.y, motion.z, motion.vx, motion.vy, motion.vz, ids, marks);
  }
};

}  // namespace particles
