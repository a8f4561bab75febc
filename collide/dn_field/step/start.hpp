// Where the particles of a block stood, and how fast they were, before the surface's rules moved
// them: a state that nothing forbids, to which whom the step led astray is put back. Private to the
// step loop.
#pragma once

#include "collide/dn_field/rules/closest.hpp"

#include <algorithm>

namespace tess::dn {

/// Whether a particle was put elsewhere.
enum class Moved : std::uint32_t { none, some };

class Start {
 public:
  void remember(const ParticleSpan& particles) {
    const std::size_t n = particles.count;
    std::copy_n(particles.x, n, x_), std::copy_n(particles.y, n, y_);
    std::copy_n(particles.z, n, z_);
    std::copy_n(particles.vx, n, vx_), std::copy_n(particles.vy, n, vy_);
    std::copy_n(particles.vz, n, vz_);
  }
  [[nodiscard]] Vec3 position(std::size_t p) const { return {x_[p], y_[p], z_[p]}; }
  [[nodiscard]] Vec3 velocity(std::size_t p) const { return {vx_[p], vy_[p], vz_[p]}; }
  [[nodiscard]] lanes::D3 places(std::size_t p) const {
    return lanes::load3(x_ + p, y_ + p, z_ + p);
  }
  [[nodiscard]] lanes::D3 velocities(std::size_t p) const {
    return lanes::load3(vx_ + p, vy_ + p, vz_ + p);
  }

 private:
  alignas(64) double x_[block_size], y_[block_size], z_[block_size];
  alignas(64) double vx_[block_size], vy_[block_size], vz_[block_size];
};

}  // namespace tess::dn
