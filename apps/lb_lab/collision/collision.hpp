// The kind of workload in which the chares are the voxels of a collision. They are made on demand
// where clusters of boxes drift, and end when the boxes have passed. A cut of the plane is the grid
// of voxels, and its number of chares per PE an upper bound: voxels without boxes do not exist.
#pragma once

#include "apps/lb_lab/run/kind.hpp"

namespace lb_lab {

extern const Kind collision_kind;

}  // namespace lb_lab
