// Where the voxels of a field stand, in the object's own coordinates: voxel (i, j, k) has its
// centre at origin + cell × (i, j, k), and x runs fastest in memory.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <array>
#include <cstddef>

namespace tess::dn {

struct Grid {
  Vec3 origin;             ///< centre of voxel (0, 0, 0)
  double cell = 1;         ///< edge of a voxel
  std::array<int, 3> n{};  ///< voxels along each axis

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
           static_cast<std::size_t>(n[2]);
  }
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(n[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(n[0]) +
           static_cast<std::size_t>(i);
  }
  /// Of a number: (i, j, k).
  [[nodiscard]] std::array<int, 3> voxel(std::size_t at) const {
    const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
    return {static_cast<int>(at % nx), static_cast<int>(at / nx % ny),
            static_cast<int>(at / nx / ny)};
  }
  [[nodiscard]] Vec3 centre(int i, int j, int k) const {
    return origin + cell * Vec3{1.0 * i, 1.0 * j, 1.0 * k};
  }
};

/// A cubic grid of n³ voxels around `box`, with at least `margin` left free on every side.
/// Throws Error(bad_argument) for n outside 4 … 1024, or a margin that leaves the object fewer than
/// two voxels.
[[nodiscard]] Grid grid_around(const Bounds& box, int n, double margin);

/// What the fastest particle and the step ask of a field.
struct Demand {
  double max_speed = 0;  ///< relative to the surface, in the object's units
  double step = 0;       ///< time step
  double detail = 0;     ///< smallest feature to resolve: at least two voxels across it
};

/// Thickness and resolution for `demand`: the field covers the distance of one step, and two cells
/// more.
struct Choice {
  Grid grid;
  double thickness = 0;
};
/// Throws Error(bad_argument) where more than `max_voxels` would be needed, naming the n it would
/// take.
[[nodiscard]] Choice choose(const Bounds& box, const Demand& demand, std::size_t max_voxels);

/// Throws Error(bad_argument) where a particle passes the field in one step and look-ups are not
/// swept.
void require_covered(const Demand& demand, double thickness);

}  // namespace tess::dn
