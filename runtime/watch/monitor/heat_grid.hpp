// How the elements of an array are laid out in a bounded picture, its heat map. Each cell holds a
// block of neighbouring elements. All processes compute the same grid from the range of the array.
//
//     1, 4 … 6 axes   blocks of ranks, row by row            2 axes   x to the right, y downwards
//     3 axes          slices of z side by side, with a gap   sparse   by the hash of the index
#pragma once

#include "runtime/core/index.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace tess::detail {

class HeatGrid {
 public:
  /// The picture has at most so many cells on each side.
  static constexpr std::int32_t most_cells = 128;

  explicit HeatGrid(const Range& range);

  [[nodiscard]] std::int32_t width() const { return width_; }
  [[nodiscard]] std::int32_t height() const { return height_; }
  [[nodiscard]] std::uint32_t n_cells() const {
    return static_cast<std::uint32_t>(width_ * height_);
  }
  /// The cell of an element, from HostedCollection::rank_of() ≥ 0.
  [[nodiscard]] std::uint32_t cell_of(std::int64_t rank) const;
  /// The number of indices in a cell; 0 in gaps, and 1 in each cell of a sparse array.
  [[nodiscard]] std::uint64_t n_indices(std::uint32_t cell) const;
  /// "[0…7,8…15]": the indices in a cell.
  [[nodiscard]] std::string text_of(std::uint32_t cell) const;

 private:
  enum class Layout : std::uint8_t { by_hash, by_rank, by_axes };
  using Axes = std::array<std::int64_t, 3>;

  /// Chooses the number of slices in a row; false if the picture is too large.
  bool arrange_slices();
  [[nodiscard]] std::int64_t n_blocks(std::size_t axis) const {
    return (extent_[axis] + block_[axis] - 1) / block_[axis];
  }
  /// The block of a cell on each axis; negative in a gap.
  [[nodiscard]] Axes block_at(std::uint32_t cell) const;
  /// The number of indices of a block on an axis.
  [[nodiscard]] std::int64_t length(std::size_t axis, std::int64_t block) const;

  Layout layout_;
  std::int32_t n_axes_;
  Axes extent_{1, 1, 1};  // by rank: all ranks on the first axis
  Axes block_{1, 1, 1};   // indices in a cell
  std::int64_t slices_in_row_ = 1;
  std::int32_t width_ = 0, height_ = 0;
};

}  // namespace tess::detail
