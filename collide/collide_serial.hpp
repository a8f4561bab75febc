// A collision in one thread, without the runtime: assigns the items to voxels, then finds the pairs
// voxel by voxel. Tests compare the parallel collider with it, and benchmarks time it.
#pragma once

#include "collide/serial/gridding.hpp"
#include "collide/serial/pair_search.hpp"

namespace tess::collide {

/// Calls found(const Item&, const Item&) exactly once per pair of items that overlap under the
/// rules, for any grid. Throws Error as group_by_voxel() does, before the first call of `found`.
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
