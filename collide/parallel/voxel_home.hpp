// The decision of a voxel's home, which has heard from all PEs: whether the voxel is made, and by
// which of the PEs that send to it.
#pragma once

#include "collide/parallel/voxel_sort.hpp"

#include <span>
#include <vector>

namespace tess::collide {

/// Which PE is the home of a voxel.
[[nodiscard]] std::size_t home_of(const Index4& voxel, std::size_t n_pes);

/// What a PE has.
struct RecordsOf {
  PeId pe;
  std::span<const VoxelRecord> records;
};

/// One answer per record of those PEs that have any. A voxel is left out if it can have no pair:
/// one object, objects of only one model, or no object of its own level. Otherwise its maker is the
/// PE where it is; if it is on none of the PEs, one of those that have at least half as many
/// objects as the PE with most: another one for another voxel.
[[nodiscard]] std::vector<std::vector<VoxelAnswer>> answers_to(std::span<const RecordsOf> all,
                                                               WithinModel within_model);

}  // namespace tess::collide
