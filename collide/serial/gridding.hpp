// Groups items by the voxels that their boxes touch, for the serial collision. A voxel exists only
// if an item touches it. An item goes to every cell of the range of its box (Lawlor and Kalé 2002,
// section 2). The order of the voxels depends only on the input; the items of a voxel are in the
// order of the input.
#pragma once

#include "collide/hit.hpp"
#include "collide/serial/voxel_grid.hpp"

#include <span>
#include <vector>

namespace tess::collide::serial {

/// The voxels that are kept. If pairs within a model do not count, voxels with a single model can
/// be dropped before any item is copied.
enum class KeepVoxels { all, of_several_models };

/// Voxels, with the indices of their items.
class VoxelGroups {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return cells_.size(); }
  [[nodiscard]] const Cell& cell(std::size_t voxel) const noexcept { return cells_[voxel]; }
  /// Indices into the grouped items, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> items(std::size_t voxel) const noexcept {
    return std::span(items_).subspan(first_[voxel], first_[voxel + 1] - first_[voxel]);
  }

 private:
  friend VoxelGroups group_by_voxel(std::span<const Item>, const VoxelGrid&, KeepVoxels);
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> first_{0};
  std::vector<std::uint32_t> items_;
};

/// Throws Error if a box is not valid, a coordinate exceeds the range of cell indices, an object
/// has more than 2^24 cells, or all objects together have 2^32.
[[nodiscard]] VoxelGroups group_by_voxel(std::span<const Item> items, const VoxelGrid& grid,
                                         KeepVoxels keep = KeepVoxels::all);

}  // namespace tess::collide::serial
