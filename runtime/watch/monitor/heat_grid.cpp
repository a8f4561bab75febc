#include "runtime/watch/monitor/heat_grid.hpp"

#include "runtime/core/text.hpp"

namespace tess::detail {
namespace {

constexpr std::int64_t cells_of_hashes = 1024;

}  // namespace

HeatGrid::HeatGrid(const Range& range) : n_axes_(range.n_axes) {
  if (!has_axes()) {
    extent_[0] = is_sparse() ? cells_of_hashes
                             : std::max<std::int64_t>(1, static_cast<std::int64_t>(range.size()));
    block_[0] = (extent_[0] + most_cells - 1) / most_cells;
    return;
  }
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(n_axes_); ++axis) {
    extent_[axis] = std::max(1, range.extent[axis]);
    while (n_blocks(axis) > most_on_axis) block_[axis] *= 2;
  }
  while (n_cells() > most_cells) {
    const Axes n = shape();
    block_[static_cast<std::size_t>(std::max_element(n.begin(), n.end()) - n.begin())] *= 2;
  }
}

std::uint32_t HeatGrid::cell_of(std::int64_t rank) const {
  if (is_sparse()) return static_cast<std::uint32_t>(rank % cells_of_hashes);
  const std::int64_t slice = rank % extent_[2] / block_[2];
  const std::int64_t row = rank / extent_[2] % extent_[1] / block_[1];
  const std::int64_t column = rank / extent_[2] / extent_[1] / block_[0];
  return static_cast<std::uint32_t>(column + n_blocks(0) * (row + n_blocks(1) * slice));
}

HeatGrid::Axes HeatGrid::first_of(std::uint32_t cell) const {
  const std::int64_t line = cell / n_blocks(0);
  return {cell % n_blocks(0) * block_[0], line % n_blocks(1) * block_[1],
          line / n_blocks(1) * block_[2]};
}

std::uint64_t HeatGrid::n_indices(std::uint32_t cell) const {
  const Axes first = first_of(cell);
  return static_cast<std::uint64_t>(length(0, first[0]) * length(1, first[1]) *
                                    length(2, first[2]));
}

std::string HeatGrid::text_of(std::uint32_t cell) const {
  if (is_sparse()) return text("hash ", cell, " of ", n_cells());
  const Axes first = first_of(cell);
  std::string out;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(has_axes() ? n_axes_ : 1); ++axis) {
    const std::int64_t last = first[axis] + length(axis, first[axis]) - 1;
    out += text(out.empty() ? "" : ",", first[axis]);
    if (last > first[axis]) out += text("…", last);
  }
  return has_axes() || n_axes_ == 1 ? text("[", out, "]") : text("rank ", out);
}

}  // namespace tess::detail
