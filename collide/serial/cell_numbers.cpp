#include "collide/serial/cell_numbers.hpp"

#include "runtime/core/error.hpp"

namespace tess::collide::serial {

void CellBounds::refuse(double n_cells, const Item& item) {
  fail(ErrorCode::bad_value, "collision: object ", static_cast<std::uint32_t>(item.id.local),
       " of owner ", static_cast<std::uint64_t>(item.id.owner), " touches ", n_cells,
       " voxels (the limits are 2^24 per object and 2^32 for all objects); take larger voxels");
}

CellNumbers::CellNumbers(const CellBounds& bounds) : low_(bounds.range.lo) {
  if (bounds.n_entries == 0) return;
  const CellRange& range = bounds.range;
  if (range.n_cells() <= 2 * bounds.n_entries + 64) {
    n_y_ = std::int64_t{range.hi.y} - range.lo.y + 1;
    n_z_ = std::int64_t{range.hi.z} - range.lo.z + 1;
    n_dense_ = static_cast<std::size_t>(range.n_cells());
    return;
  }
  std::size_t n = 64;
  while (static_cast<double>(n) < bounds.n_entries / 4) n *= 2;
  slots_.assign(n, no_number);
}

Cell CellNumbers::cell(std::uint32_t number) const noexcept {
  if (!slots_.empty()) return cells_[number];
  const std::int64_t column = number / n_z_;
  return {static_cast<std::int32_t>(low_.x + column / n_y_),
          static_cast<std::int32_t>(low_.y + column % n_y_),
          static_cast<std::int32_t>(low_.z + number % n_z_)};
}

void CellNumbers::grow() {
  slots_.assign(2 * slots_.size(), no_number);
  for (std::uint32_t i = 0; i < cells_.size(); ++i) find(cells_[i]) = i;
}

}  // namespace tess::collide::serial
