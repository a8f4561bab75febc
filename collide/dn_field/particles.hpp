// Particles as structure of arrays, in world coordinates, in double precision: at an offset of 1e9
// floats are 64 units apart, and over a million steps their rounding would change the energy.
// Fields are sampled at the position relative to the grid, computed in double and then rounded to
// float. Particles do not interact, so no result depends on their order or on their blocks.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <boost/align/aligned_allocator.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace tess::dn {

/// A view of n positions and n velocities, one array per axis. Not owned.
struct ParticleSpan {
  double *x = nullptr, *y = nullptr, *z = nullptr;
  double *vx = nullptr, *vy = nullptr, *vz = nullptr;
  std::size_t count = 0;

  /// Particles [first, first + n).
  [[nodiscard]] ParticleSpan part(std::size_t first, std::size_t n) const {
    return {x + first, y + first, z + first, vx + first, vy + first, vz + first, n};
  }
  [[nodiscard]] std::array<double*, 6> columns() const { return {x, y, z, vx, vy, vz}; }
};

/// Aligned to cache lines, so that a vector is loaded from one line.
using Values = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

struct Particles {
  Values x, y, z;     ///< position
  Values vx, vy, vz;  ///< velocity

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Vec3 position(std::size_t p) const { return {x[p], y[p], z[p]}; }
  [[nodiscard]] Vec3 velocity(std::size_t p) const { return {vx[p], vy[p], vz[p]}; }

  void resize(std::size_t n) {
    for (auto* values : {&x, &y, &z, &vx, &vy, &vz}) values->resize(n);
  }
  void push_back(Vec3 position, Vec3 velocity) {
    x.push_back(position.x), y.push_back(position.y), z.push_back(position.z);
    vx.push_back(velocity.x), vy.push_back(velocity.y), vz.push_back(velocity.z);
  }
  /// Valid until the number of particles changes.
  [[nodiscard]] ParticleSpan span() {
    return {x.data(), y.data(), z.data(), vx.data(), vy.data(), vz.data(), x.size()};
  }
};

}  // namespace tess::dn
