// Suggests a voxel size for given boxes. If voxels are too small, each object is sent to many of
// them; if they are too large, there is no parallelism, and most pairs are tested. (Lawlor and Kalé
// 2002, section 5.1, leave the choice to the user.)
#pragma once

#include "collide/hit.hpp"

namespace tess::collide {

/// The edge of cubic voxels: twice the median of the longest extents of the items, so that half of
/// the objects touch at most two voxels per axis. If all items are points, their number and bounds
/// give the size. At most 4 096 items, evenly spaced in the list, are examined. The result is
/// positive and finite, also without items, and depends only on the items.
[[nodiscard]] double suggested_voxel_size(std::span<const Item> items);

}  // namespace tess::collide
