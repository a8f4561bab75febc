// What every construction refuses before it begins.
#pragma once

#include "collide/dn_field/grid.hpp"

namespace tess::dn {

/// Throws Error(bad_argument) for a grid without voxels, or whose cells or origin have no finite
/// size, and Error(environment) where `bytes_per_voxel` for all its voxels are more than
/// usable_memory().
void require_buildable(const Grid& grid, double bytes_per_voxel);

/// Throws Error(bad_argument) for a thickness below two cells, or NaN.
void require_thick(const Grid& grid, double thickness);

}  // namespace tess::dn
