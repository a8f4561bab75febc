// Which voxels lie inside a surface with holes and flipped triangles: those with a winding number
// above 1/2. Every rim is closed by a cap, a cone of triangles over it. The winding number of the
// surface with its caps is an integer, which is counted along lines of voxels, and
//
//     winding of the surface = winding with caps − winding of the caps.
//
// Only the caps are summed over triangles, and only where their share is near a half; elsewhere one
// estimate decides a tile of voxels. A closed surface has no caps. If so many triangles are flipped
// or missing that the caps would cost more than the surface, the surface itself is summed by the
// same estimates, without caps and lines. Immutable once made; any thread.
#pragma once

#include "collide/dn_field/build/winding_lines.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/orientation.hpp"

#include <optional>

namespace tess::dn {

class Inside {
 public:
  /// `tree` is that of `surface` and must outlive this.
  Inside(const OutwardSurface& surface, const Bvh& tree, const Grid& grid);

  /// Layers first to last − 1. inside: (last − first) × n[1] × n[0], x fastest; 1 inside, 0
  /// outside.
  void layers(int first, int last, std::span<std::uint8_t> inside) const;

 private:
  struct Tile {
    std::array<int, 3> low, high;  // voxels, high not included
  };
  void decide(const Tile& tile, int first, std::span<const std::int16_t> winding,
              std::span<std::uint8_t> inside) const;
  /// The lines' count minus the winding number of the surface.
  [[nodiscard]] WindingEstimate excess(Vec3 p, double radius, double accuracy) const;
  [[nodiscard]] bool decide_voxel(Vec3 p, int winding) const;

  const Bvh& tree_;
  Grid grid_;
  std::optional<Bvh> caps_;
  std::optional<WindingLines> lines_;  // none: their count is 0
};

}  // namespace tess::dn
