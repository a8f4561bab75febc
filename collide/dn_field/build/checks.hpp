// The checks before every construction.
#pragma once

#include "collide/dn_field/grid.hpp"

namespace tess::dn {

/// Throws Error(bad_argument) for a grid without voxels, or with cells or an origin that are not
/// finite, and Error(environment) where `bytes_per_voxel` for all its voxels are more than
/// usable_memory().
void require_buildable(const Grid& grid, double bytes_per_voxel);

/// Throws Error(bad_argument) for a thickness below two cells, or NaN.
void require_thick(const Grid& grid, double thickness);

}  // namespace tess::dn
