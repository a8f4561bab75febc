// The voxels that a surface passes through, and its normal in each: what the paper's two methods
// start from.
#pragma once

#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/surface.hpp"

#include <vector>

namespace tess::dn {

struct SurfaceVoxel {
  std::size_t at = 0;  ///< number in the grid
  Vec3 normal;         ///< average of the unit normals of the triangles that hit it; not normalised
};

/// All voxels whose cube a triangle meets, in the order of the grid. A triangle meets a voxel when
/// it comes as near to the centre as the plane of a face may and still cut the cube. One that lies
/// between two layers, to rounding, meets both. Empty where the surface stands outside the grid.
[[nodiscard]] std::vector<SurfaceVoxel> surface_voxels(const Surface& surface, const Grid& grid);

}  // namespace tess::dn
