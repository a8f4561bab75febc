// Which voxels lie inside a surface: those with a winding number above 1/2. The number of a closed
// surface is counted along lines of voxels in x: it changes by one where the line crosses a
// triangle, so that the cost is the number of crossings instead of voxels × triangles. A surface
// with holes or flipped triangles has fractions; they are summed at each voxel (Bvh::is_inside).
// Immutable once made; any thread, layers are independent.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::dn {

class Inside {
 public:
  /// `tree` is that of `surface` and must outlive this.
  Inside(Surface surface, const Bvh& tree, const Grid& grid);

  /// The voxels of layer `k`. inside: n[1] × n[0], x fastest; 1 inside, 0 outside.
  void layer(int k, std::span<std::uint8_t> inside) const;

 private:
  void count_crossings(std::uint32_t triangle, int k, std::span<std::int32_t> change) const;

  Surface surface_;
  const Bvh& tree_;
  Grid grid_;
  bool closed_;
  // Of closed surfaces: the triangles that the lines of a layer can cross, and where each layer
  // begins among them.
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace tess::dn
