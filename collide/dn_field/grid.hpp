// The voxels of a field in the object's own coordinates: voxel (i, j, k) has its centre at
// origin + cell × (i, j, k), and x runs fastest in memory.
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
  [[nodiscard]] Vec3 centre(int i, int j, int k) const {
    return origin + cell * Vec3{1.0 * i, 1.0 * j, 1.0 * k};
  }
  /// From the centre of the first voxel to that of the last.
  [[nodiscard]] Bounds box() const { return {origin, centre(n[0] - 1, n[1] - 1, n[2] - 1)}; }
};

/// A cubic grid of n³ voxels around `box`, with at least `margin` left free on every side.
/// Throws Error(bad_argument) for n outside 4 … 1024, or a margin that leaves the object fewer than
/// two voxels.
[[nodiscard]] Grid grid_around(const Bounds& box, int n, double margin);

}  // namespace tess::dn
