// How often a closed surface winds around each voxel of a grid: along each line of voxels in x the
// number changes by one where the line passes a triangle. Costs the number of line crossings, not
// of voxels × triangles. Layers are independent; any thread.
#pragma once

#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::dn {

class WindingLines {
 public:
  /// Stands for a voxel of a line on which rounding lost a crossing, so that it does not end at
  /// zero.
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
  std::vector<std::uint32_t> triangles_;  // that a layer's lines can pass
};

}  // namespace tess::dn
