// The kind of workload whose chares are the voxels of a collision, made on demand where clusters of
// boxes drift, and gone when they have passed. A cut of the plane is the grid of voxels: at most so
// many chares a PE; those that nothing touches do not exist.
#pragma once

#include "apps/lb_lab/run/kind.hpp"

namespace lb_lab {

extern const Kind collision_kind;

}  // namespace lb_lab
