// Items grouped by the voxels that their boxes touch. Sparse: a voxel exists only where an item is.
// Sloppy: an item goes to each cell of its box's range (Lawlor and Kalé 2002, section 2). The
// Manager sends one message a voxel from it; the serial collider walks it. The order of voxels and
// of the items in one depends on the input alone: items stand in input order.
#pragma once

#include "collide/hit.hpp"
#include "collide/serial/voxel_grid.hpp"

#include <span>
#include <vector>

namespace tess::collide::serial {

/// Which voxels are kept. On one PE a voxel of a single model can be dropped before anything is
/// copied; a Manager does not know what others send to a voxel and keeps all.
enum class KeepVoxels { all, of_several_models };

/// Voxels and, for each, the indices of its items.
class VoxelGroups {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return cells_.size(); }
  [[nodiscard]] const Cell& cell(std::size_t voxel) const noexcept { return cells_[voxel]; }
  /// Indices into the items that were grouped, ascending.
  [[nodiscard]] std::span<const std::uint32_t> items(std::size_t voxel) const noexcept {
    return std::span(items_).subspan(first_[voxel], first_[voxel + 1] - first_[voxel]);
  }

 private:
  friend VoxelGroups group_by_voxel(std::span<const Item>, const VoxelGrid&, KeepVoxels);
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> first_{0};
  std::vector<std::uint32_t> items_;
};

/// Errors: an invalid box, a coordinate without a cell, an object of more than 2^24 cells, or 2^32
/// entries in all.
[[nodiscard]] VoxelGroups group_by_voxel(std::span<const Item> items, const VoxelGrid& grid,
                                         KeepVoxels keep = KeepVoxels::all);

}  // namespace tess::collide::serial
