#include "runtime/watch/monitor/heat_grid.hpp"

#include "runtime/core/text.hpp"

#include <algorithm>

namespace tess::detail {
namespace {

constexpr std::int32_t cells_of_hashes = 32;  // on each side

}  // namespace

HeatGrid::HeatGrid(const Range& range)
    : layout_(range.n_axes == 0                        ? Layout::by_hash
              : range.n_axes == 2 || range.n_axes == 3 ? Layout::by_axes
                                                       : Layout::by_rank),
      n_axes_(range.n_axes) {
  if (layout_ == Layout::by_hash) {
    width_ = height_ = cells_of_hashes;
  } else if (layout_ == Layout::by_rank) {
    constexpr std::int64_t most = std::int64_t{most_cells} * most_cells;
    extent_[0] = std::max<std::int64_t>(1, static_cast<std::int64_t>(range.size()));
    block_[0] = (extent_[0] + most - 1) / most;
    const std::int64_t n = n_blocks(0);
    // Short arrays are drawn in rows of equal length, as near to a square as a picture of 2:1.
    std::int64_t width = std::min<std::int64_t>(most_cells, n);
    while (width > 8 && width * width > 2 * n) width /= 2;
    width_ = static_cast<std::int32_t>(width);
    height_ = static_cast<std::int32_t>((n + width - 1) / width);
  } else {
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(n_axes_); ++axis) {
      extent_[axis] = std::max(1, range.extent[axis]);
      while (n_blocks(axis) > most_cells) block_[axis] *= 2;
    }
    while (!arrange_slices()) {
      std::size_t longest = 0;
      for (std::size_t axis = 1; axis < 3; ++axis)
        if (n_blocks(axis) > n_blocks(longest)) longest = axis;
      block_[longest] *= 2;
    }
  }
}

bool HeatGrid::arrange_slices() {
  const std::int64_t columns = n_blocks(0), rows = n_blocks(1), slices = n_blocks(2);
  std::int64_t best = most_cells + 1;
  for (std::int64_t in_row = 1; in_row <= slices; ++in_row) {
    const std::int64_t width = in_row * (columns + 1) - 1;
    const std::int64_t height = (slices + in_row - 1) / in_row * (rows + 1) - 1;
    if (std::max(width, height) >= best) continue;
    best = std::max(width, height);
    slices_in_row_ = in_row;
    width_ = static_cast<std::int32_t>(width);
    height_ = static_cast<std::int32_t>(height);
  }
  return best <= most_cells;
}

std::uint32_t HeatGrid::cell_of(std::int64_t rank) const {
  if (layout_ == Layout::by_hash) return static_cast<std::uint32_t>(rank % n_cells());
  if (layout_ == Layout::by_rank) return static_cast<std::uint32_t>(rank / block_[0]);
  const std::int64_t slice = rank % extent_[2] / block_[2];
  const std::int64_t row = rank / extent_[2] % extent_[1] / block_[1];
  const std::int64_t column = rank / extent_[2] / extent_[1] / block_[0];
  const std::int64_t x = slice % slices_in_row_ * (n_blocks(0) + 1) + column;
  const std::int64_t y = slice / slices_in_row_ * (n_blocks(1) + 1) + row;
  return static_cast<std::uint32_t>(y * width_ + x);
}

HeatGrid::Axes HeatGrid::block_at(std::uint32_t cell) const {
  constexpr Axes gap{-1, -1, -1};
  if (layout_ == Layout::by_rank) {
    if (cell >= n_blocks(0)) return gap;
    return {cell, 0, 0};
  }
  const std::int64_t x = cell % static_cast<std::uint32_t>(width_);
  const std::int64_t y = cell / static_cast<std::uint32_t>(width_);
  const std::int64_t columns = n_blocks(0) + 1, rows = n_blocks(1) + 1;
  const std::int64_t slice = y / rows * slices_in_row_ + x / columns;
  if (x % columns == columns - 1 || y % rows == rows - 1 || slice >= n_blocks(2)) return gap;
  return {x % columns, y % rows, slice};
}

std::int64_t HeatGrid::length(std::size_t axis, std::int64_t block) const {
  return std::min(block_[axis], extent_[axis] - block * block_[axis]);
}

std::uint64_t HeatGrid::n_indices(std::uint32_t cell) const {
  if (layout_ == Layout::by_hash) return 1;
  const Axes at = block_at(cell);
  if (at[0] < 0) return 0;
  return static_cast<std::uint64_t>(length(0, at[0]) * length(1, at[1]) * length(2, at[2]));
}

std::string HeatGrid::text_of(std::uint32_t cell) const {
  if (layout_ == Layout::by_hash) return text("hash ", cell, " of ", n_cells());
  const Axes at = block_at(cell);
  if (at[0] < 0) return "none";
  std::string out;
  const std::int32_t n = layout_ == Layout::by_rank ? 1 : n_axes_;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(n); ++axis) {
    const std::int64_t first = at[axis] * block_[axis];
    const std::int64_t last = first + length(axis, at[axis]) - 1;
    out += text(out.empty() ? "" : ",", first);
    if (last > first) out += text("…", last);
  }
  return layout_ == Layout::by_rank && n_axes_ != 1 ? text("rank ", out) : text("[", out, "]");
}

}  // namespace tess::detail
