// Particles on the plane of a problem, drawn to an attractor that travels: each moves by itself,
// with drag and random kicks, so that they bunch up without meeting in a point. The path of a
// particle depends on its number only, not on the chare, the PE or the other particles.
#pragma once

#include "apps/lb_lab/workload/workload.hpp"

#include <cstdint>
#include <vector>

namespace lb_lab {

struct Particle {
  std::uint64_t number = 0;
  double x = 0, y = 0;    ///< in cells: within [0, width) × [0, height)
  double vx = 0, vy = 0;  ///< cells a run
};

class Swarm {
 public:
  explicit Swarm(const Problem& problem);

  [[nodiscard]] std::uint64_t size() const { return n_particles_; }
  /// Nominal, at speed 1, of a particle in an iteration.
  [[nodiscard]] double seconds() const { return seconds_; }

  /// Before the first iteration: evenly over the plane, in the order of x.
  [[nodiscard]] Particle first(std::uint64_t number) const;

  /// One iteration of particles: `n_substeps` steps of each.
  void advance(std::vector<Particle>& particles, std::int32_t iteration) const;

  /// A particle's part of the answer.
  [[nodiscard]] static std::uint64_t answer(const Particle& particle);

 private:
  struct Place {
    double x, y;
  };
  [[nodiscard]] Place attractor(double iteration) const;
  void advance(Particle& particle, std::int32_t iteration, const Place* attractors) const;

  double width_, height_, n_iterations_;
  std::uint64_t seed_, n_particles_;
  double seconds_;
};

}  // namespace lb_lab
