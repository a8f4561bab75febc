// The winding number of a closed surface at each voxel of a grid: along a line of voxels in x it
// changes by one where the line crosses a triangle. The cost is the number of crossings instead of
// voxels × triangles. Layers are independent; any thread.
#pragma once

#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::dn {

class WindingLines {
 public:
  /// Marks the voxels of a line on which rounding lost a crossing: its count does not end at zero.
  static constexpr std::int16_t unknown = INT16_MIN;

  /// `surface` must be closed (is_closed).
  WindingLines(Surface surface, const Grid& grid);

  /// The winding number of each voxel of layer `k`. winding: n[1] × n[0], x fastest.
  void layer(int k, std::span<std::int16_t> winding) const;

 private:
  void cross(std::uint32_t triangle, int k, std::span<std::int16_t> change) const;

  Surface surface_;
  Grid grid_;
  std::vector<std::size_t> begin_;        // of each layer in triangles_
  std::vector<std::uint32_t> triangles_;  // that the lines of a layer can cross
};

}  // namespace tess::dn
