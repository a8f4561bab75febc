// The particles of a scene at the first step. All numbers of particle i are computed from the seed
// of its emitter and i only, so that any PE can make any of them.
#pragma once

#include "apps/particles/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace particles {

/// A particle as it is emitted.
struct Start {
  tess::dn::Vec3 position, velocity;
  double mass = 1;
};

class Source {
 public:
  explicit Source(const Scene& scene);

  /// Of all emitters.
  [[nodiscard]] std::uint64_t size() const { return first_.back(); }
  /// Particle `id`, 0 … size() − 1, in the order of the emitters.
  [[nodiscard]] Start particle(std::uint64_t id) const;
  /// A box that holds all first positions.
  [[nodiscard]] tess::dn::Bounds bounds() const;

 private:
  const Scene& scene_;
  std::vector<std::uint64_t> first_;        // id of the first particle of each emitter, and the end
  std::vector<std::vector<double>> areas_;  // per object that emits: sums up to each triangle
};

}  // namespace particles
