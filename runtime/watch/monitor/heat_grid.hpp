// The cells of an array's heat map, each a block of neighbouring elements, so that their number is
// bounded. All processes compute the same cells from the range of the array; browsers lay them out.
//
//     2, 3 axes   blocks of indices: cell = x + columns * (y + rows * z)
//     1, 4 … 6    blocks of ranks
//     sparse      by the hash of the index
#pragma once

#include "runtime/core/index.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace tess::detail {

class HeatGrid {
 public:
  using Axes = std::array<std::int64_t, 3>;
  static constexpr std::int64_t most_on_axis = 128;  ///< of two or three axes
  static constexpr std::int64_t most_cells = most_on_axis * most_on_axis;

  explicit HeatGrid(const Range& range);

  /// Columns, rows, slices.
  [[nodiscard]] Axes shape() const { return {n_blocks(0), n_blocks(1), n_blocks(2)}; }
  [[nodiscard]] std::uint32_t n_cells() const {
    return static_cast<std::uint32_t>(n_blocks(0) * n_blocks(1) * n_blocks(2));
  }
  /// The cell of an element, from HostedCollection::rank_of() ≥ 0.
  [[nodiscard]] std::uint32_t cell_of(std::int64_t rank) const;
  /// The number of indices in a cell; 1 in each cell of a sparse array.
  [[nodiscard]] std::uint64_t n_indices(std::uint32_t cell) const;
  /// "[0…7,8…15]": the indices in a cell.
  [[nodiscard]] std::string text_of(std::uint32_t cell) const;

 private:
  [[nodiscard]] bool is_sparse() const { return n_axes_ == 0; }
  [[nodiscard]] bool has_axes() const { return n_axes_ == 2 || n_axes_ == 3; }
  [[nodiscard]] std::int64_t n_blocks(std::size_t axis) const {
    return (extent_[axis] + block_[axis] - 1) / block_[axis];
  }
  /// The first index of a cell on each axis, and the number of indices there.
  [[nodiscard]] Axes first_of(std::uint32_t cell) const;
  [[nodiscard]] std::int64_t length(std::size_t axis, std::int64_t first) const {
    return std::min(block_[axis], extent_[axis] - first);
  }

  std::int32_t n_axes_;
  Axes extent_{1, 1, 1};  // without axes: all ranks on the first one
  Axes block_{1, 1, 1};   // indices in a cell
};

}  // namespace tess::detail
