// Sorts the objects of a PE into the voxels of a plan.
#pragma once

#include "collide/parallel/object_list.hpp"
#include "collide/parallel/plan.hpp"
#include "collide/problem/cell_numbers.hpp"
#include "collide/problem/entry.hpp"
#include "collide/problem/scratch.hpp"
#include "runtime/core/ids.hpp"
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
  std::uint32_t is_here = 0;  ///< the voxel exists on this PE
};

/// The answer of the voxel's home.
struct VoxelAnswer {
  std::uint32_t n_senders = 0;  ///< 0: the voxel is left out
  PeId maker{};                 ///< the PE that makes the voxel
};

/// Keeps its memory from sort to sort.
class VoxelSort {
 public:
  void run(const Plan& plan, const ObjectList& objects);
  /// Calls is_here(voxel) for each record.
  template <class IsHere>
  void note_places(const IsHere& is_here) {
    for (VoxelRecord& record : records_) record.is_here = is_here(record.voxel) ? 1 : 0;
  }
  void clear();

  [[nodiscard]] const std::vector<VoxelRecord>& records() const noexcept { return records_; }
  /// An object counts in each voxel that it touches.
  [[nodiscard]] std::size_t n_entries() const noexcept { return n_entries_; }

  /// The entries of the voxels that are not left out, voxel after voxel in the order of the
  /// records: first the natives, then the visitors. One answer per record. Called once per sort.
  void write_sorted(std::span<const VoxelAnswer> answers, std::vector<search::Entry>& sorted);

 private:
  void sort_level(const Plan& plan, const ObjectList& objects, Level level);
  /// Writes the numbers of the cells that objects touch, and their entries.
  template <class IsWanted>
  void spread(std::span<const Aabb> boxes, const VoxelGrid& grid, search::CellNumbers& numbers,
              const IsWanted& is_wanted);
  void note_models(const ObjectList& objects);

  /// A level: its cells are numbered from 0, and its entries stand together.
  struct Sorted {
    std::size_t begin, first_visitor, end;  // of the entries
    std::size_t first_slot, n_cells;        // natives of a cell have the slot 2 * number, visitors
                                            // the one after it
  };

  std::vector<VoxelRecord> records_;  // of the cells that have entries, in the order of the slots
  std::vector<Sorted> levels_;
  search::Scratch<std::uint32_t> cell_of_, entry_of_;  // per object and voxel
  std::size_t n_entries_ = 0;
  std::vector<std::uint32_t> slots_;  // how many entries; then the position of the next
};

}  // namespace tess::collide
