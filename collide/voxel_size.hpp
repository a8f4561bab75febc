// A voxel size for given boxes: too small sends each object to many voxels, too large leaves no
// parallelism and tests everything with everything (Lawlor and Kalé 2002, section 5.1, leave the
// choice to the user). Pure: the same boxes give the same size.
#pragma once

#include "collide/hit.hpp"

namespace tess::collide {

/// An edge for cubic voxels: twice the median over the items of their longest extent, so that half
/// the objects touch at most two voxels an axis. Points alone: from their number and bounds. Looks
/// at no more than 4 096 items, evenly taken. Always positive and finite, also for no items.
[[nodiscard]] double suggested_voxel_size(std::span<const Item> items);

}  // namespace tess::collide
