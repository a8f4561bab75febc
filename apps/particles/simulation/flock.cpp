#include "apps/particles/simulation/flock.hpp"

namespace particles {

void Flock::append(const Flock& other) {
  const auto join = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  join(motion.x, other.motion.x), join(motion.y, other.motion.y), join(motion.z, other.motion.z);
  join(motion.vx, other.motion.vx), join(motion.vy, other.motion.vy);
  join(motion.vz, other.motion.vz);
  join(ids, other.ids), join(marks, other.marks);
}

void Flock::remove(std::size_t p) {
  const auto take = [p](auto& values) {
    values[p] = values.back();
    values.pop_back();
  };
  take(motion.x), take(motion.y), take(motion.z);
  take(motion.vx), take(motion.vy), take(motion.vz);
  take(ids), take(marks);
}

}  // namespace particles
