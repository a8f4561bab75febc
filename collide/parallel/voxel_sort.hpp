// Sorts the objects of a PE into the voxels of a plan.
#pragma once

#include "collide/parallel/object_list.hpp"
#include "collide/parallel/plan.hpp"
#include "collide/search/entry.hpp"
#include "collide/search/scratch.hpp"
#include "collide/serial/cell_numbers.hpp"
#include "runtime/core/index.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::collide {

/// What a PE has for a voxel.
struct VoxelRecord {
  Index4 voxel;                  ///< the cell, and the level
  std::uint32_t n_natives = 0;   ///< objects of the voxel's level
  std::uint32_t n_visitors = 0;  ///< smaller ones
  ModelId model{};               ///< of the objects, unless there are several
  std::uint32_t several_models = 0;
};

/// The answer of the voxel's home.
struct VoxelAnswer {
  std::uint32_t n_senders = 0;  ///< 0: the voxel is left out
  std::uint32_t makes_it = 0;   ///< this PE makes the voxel
};

class VoxelSort {
 public:
  VoxelSort() = default;
  /// `bounds`: of the objects.
  VoxelSort(const Plan& plan, const ObjectList& objects, const Aabb& bounds);

  [[nodiscard]] const std::vector<VoxelRecord>& records() const noexcept { return records_; }

  /// The entries of the voxels that are not left out, voxel after voxel in the order of the
  /// records: first the natives, then the visitors. One answer per record.
  [[nodiscard]] std::vector<search::Entry> sorted(std::span<const VoxelAnswer> answers) const;

 private:
  void sort_level(const Plan& plan, const std::vector<Aabb>& boxes, const Aabb& bounds,
                  Level level);
  /// Writes the numbers of the cells that objects touch, to slot_of_, and their entries.
  template <class IsWanted>
  void spread(std::span<const Aabb> boxes, const VoxelGrid& grid, serial::CellNumbers& numbers,
              const IsWanted& is_wanted);
  void note_models(const ObjectList& objects);

  std::vector<VoxelRecord> records_;
  // Per object and voxel: twice the position of the record, plus 1 for a visitor; and the entry.
  search::Scratch<std::uint32_t> slot_of_, entry_of_;
  std::size_t n_entries_ = 0;
};

}  // namespace tess::collide
