// Measures of all particles after a step: sums, extremes and counts that are the same bit for bit
// for every order in which particles, blocks and PEs are joined.
#pragma once

#include "runtime/core/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace particles {

using tess::ExactSum;

struct Measured {
  std::uint64_t particles = 0;
  std::uint64_t blocks = 0;
  std::uint64_t nonfinite = 0;
  std::uint64_t inside = 0;     ///< below the surface of an object
  std::uint64_t tunnelled = 0;  ///< went through a surface
  double fastest = 0;           ///< speed
  double nearest = HUGE_VAL;    ///< least signed distance to an object, in world units
  ExactSum kinetic, potential;  ///< m v²/2 and −m g·x
  std::uint64_t hash = 0;       ///< of ids and the bits of positions and velocities

  void add(const Measured& other) {
    particles += other.particles;
    blocks += other.blocks;
    nonfinite += other.nonfinite;
    inside += other.inside;
    tunnelled += other.tunnelled;
    fastest = std::max(fastest, other.fastest);
    nearest = std::min(nearest, other.nearest);
    kinetic.add(other.kinetic);
    potential.add(other.potential);
    hash += other.hash;
  }
  friend Measured operator+(Measured a, const Measured& b) {
    a.add(b);
    return a;
  }
  /// Kinetic and potential; like kinetic.total() infinite or not a number where that of a particle
  /// is beyond all doubles. Particles with positions or velocities that are not finite are left
  /// out.
  [[nodiscard]] double energy() const {
    ExactSum both = kinetic;
    both.add(potential);
    return both.total();
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(particles, blocks, nonfinite, inside, tunnelled, fastest, nearest, kinetic, potential, hash);
  }
};

}  // namespace particles
