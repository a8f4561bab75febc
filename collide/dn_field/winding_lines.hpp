// Inside or outside for all voxels of a grid around a closed surface: along each line of voxels in
// x the winding number changes by one where the line passes a triangle. Costs the number of line
// crossings, not of voxels × triangles.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/grid.hpp"

#include <cstdint>
#include <vector>

namespace tess::dn {

/// 1 for voxels inside (winding number at least 1), 0 outside. `surface` must be closed
/// (is_closed). A line on which rounding lost a crossing does not end at zero; it is done again by
/// `tree`, voxel by voxel.
[[nodiscard]] std::vector<std::uint8_t> inside_by_lines(const Surface& surface,
                                                        const Bvh& tree,
                                                        const Grid& grid);

}  // namespace tess::dn
