// The voxels that a surface passes through, and its normal in each: the paper's two methods start
// from them.
#pragma once

#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/surface.hpp"

#include <vector>

namespace tess::dn {

struct SurfaceVoxel {
  std::size_t at = 0;  ///< number in the grid
  Vec3 normal;         ///< average of the unit normals of the triangles that hit it; not normalised
};

/// All voxels with a cube that a triangle meets, in the order of the grid. A triangle meets a voxel
/// if its distance from the centre is at most that at which its plane still cuts the cube; one
/// between two layers, up to rounding, meets both. Empty if the surface lies outside the grid.
[[nodiscard]] std::vector<SurfaceVoxel> surface_voxels(const Surface& surface, const Grid& grid);

}  // namespace tess::dn
