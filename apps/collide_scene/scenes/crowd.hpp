// Many closed bodies that move through each other, in clusters of uneven density: work that shifts
// from place to place. The pose of a body is a function of its number and the step, so every PE and
// every run computes the same.
//
//     ⁖⁘⁙⁘ →   ∴ ⁖        Cluster c has a share of the bodies proportional to 2^-c, and all clusters
//     ⁙⁘⁖⁙      ↙    ·    have one radius. Each goes around a common centre, and its bodies around
//                         the centre of the cluster, the inner ones faster.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

#include <array>

namespace collide_scene {

class Crowd {
 public:
  static constexpr std::uint64_t triangles_per_body = 128;

  Crowd(std::uint64_t n_bodies, std::uint64_t seed);

  [[nodiscard]] std::uint64_t n_bodies() const noexcept { return bodies_.size(); }
  /// The triangles of a body at a step, which may be fractional: the same mesh each time, moved as
  /// a rigid body. `out` has triangles_per_body places.
  void triangles(std::uint64_t body, double step, std::span<tess::collide::Triangle> out) const;

 private:
  struct Body {
    std::uint32_t cluster;
    double distance, height, phase;  // from the axis of the cluster, along it, in turns about it
    double spin, scale;              // turns per step about its own axis; size
  };
  [[nodiscard]] tess::collide::Point centre(const Body& body, double step) const noexcept;

  double cluster_radius_;
  std::vector<Body> bodies_;
  std::array<tess::collide::Triangle, triangles_per_body> mesh_;
};

/// A crowd of at least one body and about n triangles; each body is a model. It moves.
[[nodiscard]] Scene crowd(std::uint64_t n, std::uint64_t seed);

}  // namespace collide_scene
