// Numbers the cells of a collision 0, 1, 2, … so that voxels can be counted and filled in plain
// arrays. If the cells in use fill their bounding range well, the number is the position in that
// range, z fastest, and costs two multiplications (dense numbering). Otherwise a hash table numbers
// the cells in the order of their first use, and empty space costs nothing. The choice depends only
// on the input.
#pragma once

#include "collide/problem/voxel_grid.hpp"
#include "runtime/core/algorithm.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace tess::collide::search {

class CellNumbers {
 public:
  /// For cells of this range, of which about `n_used` are used.
  CellNumbers(const CellRange& range, double n_used);

  /// All numbers are below this. In a dense numbering it is the number of cells of the range.
  [[nodiscard]] std::size_t size() const noexcept {
    return slots_.empty() ? n_dense_ : cells_.size();
  }
  [[nodiscard]] Cell cell(std::uint32_t number) const noexcept;

  /// In a dense numbering: the number of a cell in the range, and what a step along each axis adds.
  [[nodiscard]] bool is_dense() const noexcept { return slots_.empty(); }
  [[nodiscard]] std::uint32_t dense_number(const Cell& c) const noexcept {
    return static_cast<std::uint32_t>(
        ((std::int64_t{c.x} - low_.x) * n_y_ + (std::int64_t{c.y} - low_.y)) * n_z_ +
        (std::int64_t{c.z} - low_.z));
  }
  [[nodiscard]] std::array<std::uint32_t, 3> strides() const noexcept {
    return {static_cast<std::uint32_t>(n_y_ * n_z_), static_cast<std::uint32_t>(n_z_), 1};
  }

  /// Calls visit(number, below) per cell of `range`, x slowest; below has bit k set if the cell is
  /// above range.lo on axis k. A cell without a number gets one.
  template <class Visit>
  void for_each(const CellRange& range, Visit&& visit) {
    for (std::int64_t x = range.lo.x; x <= range.hi.x; ++x)
      for (std::int64_t y = range.lo.y; y <= range.hi.y; ++y) {
        const std::uint32_t below = (x > range.lo.x ? 1U : 0U) | (y > range.lo.y ? 2U : 0U);
        const std::int64_t row =
            slots_.empty() ? ((x - low_.x) * n_y_ + (y - low_.y)) * n_z_ - low_.z : 0;
        for (std::int64_t z = range.lo.z; z <= range.hi.z; ++z)
          visit(slots_.empty()
                    ? static_cast<std::uint32_t>(row + z)
                    : number(Cell{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                                  static_cast<std::int32_t>(z)}),
                below | (z > range.lo.z ? 4U : 0U));
      }
  }

 private:
  static constexpr std::uint32_t no_number = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t number(const Cell& cell) {
    if (2 * cells_.size() >= slots_.size()) grow();
    std::uint32_t& slot = find(cell);
    if (slot == no_number) {
      slot = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(cell);
    }
    return slot;
  }
  std::uint32_t& find(const Cell& cell) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = std::hash<Cell>{}(cell)&mask;
    while (slots_[at] != no_number && cells_[slots_[at]] != cell) at = (at + 1) & mask;
    return slots_[at];
  }
  void grow();

  Cell low_;
  std::int64_t n_y_ = 0, n_z_ = 0;
  std::size_t n_dense_ = 0;
  std::vector<std::uint32_t> slots_;  // open addressing, at most half full; empty if dense
  std::vector<Cell> cells_;           // by number, unless dense
};

}  // namespace tess::collide::search
