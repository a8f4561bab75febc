// The whole collision in one thread: gridding, then the serial step voxel by voxel. What the
// parallel collider must reproduce, and what benchmarks time.
#pragma once

#include "collide/serial/gridding.hpp"
#include "collide/serial/pair_search.hpp"

namespace tess::collide {

/// Calls found(const Item&, const Item&) exactly once for each pair of items that overlap under the
/// rules, whatever the grid. Errors: as group_by_voxel(), before the first call.
template <class Found>
void collide_serial(std::span<const Item> items, const VoxelGrid& grid, PairRules rules,
                    Found&& found, SerialMethod method = SerialMethod::automatic) {
  const auto keep = rules.within_model == WithinModel::skip ? serial::KeepVoxels::of_several_models
                                                            : serial::KeepVoxels::all;
  const serial::VoxelGroups groups = serial::group_by_voxel(items, grid, keep);
  serial::PairSearch search(rules, method);
  for (std::size_t v = 0; v < groups.size(); ++v)
    search.for_each_pair(items, groups.items(v), groups.cell(v), grid, found);
}

}  // namespace tess::collide
