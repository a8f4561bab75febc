#include "collide/problem/voxel_grid.hpp"

#include "runtime/core/error.hpp"

#include <cmath>

namespace tess::collide {

VoxelGrid::VoxelGrid(const Point& origin, const Point& size)
    : origin_(origin), size_(size), per_voxel_{1 / size[0], 1 / size[1], 1 / size[2]} {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!std::isfinite(origin[k]))
      fail(ErrorCode::bad_value, "voxel grid: origin ", origin[k], " on axis ", k,
           " is not finite; give finite numbers");
    if (!(size[k] > 0) || !std::isfinite(size[k]) || !std::isfinite(per_voxel_[k]))
      fail(ErrorCode::bad_value, "voxel grid: voxel size ", size[k], " on axis ", k,
           " and its inverse must be positive and finite; give a size for each axis, or 0 for all: "
           "chosen");
    for (const std::size_t lane : {k, k + 3}) {
      constants_.origin[lane] = origin[k];
      constants_.per_voxel[lane] = per_voxel_[k];
    }
  }
}

std::int32_t VoxelGrid::index(double x, std::size_t axis) const {
  const double cell = std::floor((x - origin_[axis]) * per_voxel_[axis]);
  if (!(cell >= -2147483648.0 && cell <= 2147483647.0))
    fail(ErrorCode::out_of_range, "voxel grid: coordinate ", x, " on axis ", axis,
         " has no 32-bit cell at voxel size ", size_[axis],
         "; take larger voxels or move the origin closer");
  return static_cast<std::int32_t>(cell);
}

}  // namespace tess::collide
