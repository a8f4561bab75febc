// The decision of a voxel's home, which has heard from all PEs: whether the voxel is made, and by
// which of the PEs that send to it.
#pragma once

#include "collide/parallel/voxel_sort.hpp"

#include <span>
#include <vector>

namespace tess::collide {

/// Which PE is the home of a voxel.
[[nodiscard]] std::size_t home_of(const Index4& voxel, std::size_t n_pes);

/// One answer per record; `records` are by PE, and only of PEs that have any. A voxel is left out if it can
/// have no pair: one object, objects of only one model, or no object of its own level. Otherwise
/// one of the PEs makes it that have at least half as many objects as the PE with most: another one
/// for another voxel.
[[nodiscard]] std::vector<std::vector<VoxelAnswer>> answers_to(
    std::span<const std::span<const VoxelRecord>> records, WithinModel within_model);

}  // namespace tess::collide
