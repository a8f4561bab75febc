#include "collide/serial/cell_numbers.hpp"

#include "runtime/core/error.hpp"

namespace tess::collide::serial {

void CellBounds::refuse(double n_cells, const Item& item) {
  fail(ErrorCode::bad_value, "gridding: object ", static_cast<std::uint32_t>(item.id.local),
       " of owner ", static_cast<std::uint64_t>(item.id.owner), " touches ", n_cells,
       " voxels (at most 2^24 each, 2^32 in all): take larger voxels");
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
  slots_.assign(n, kNone);
}

Cell CellNumbers::cell(std::uint32_t number) const noexcept {
  if (!slots_.empty()) return cells_[number];
  const std::int64_t column = number / n_z_;
  return {static_cast<std::int32_t>(low_.x + column / n_y_),
          static_cast<std::int32_t>(low_.y + column % n_y_),
          static_cast<std::int32_t>(low_.z + number % n_z_)};
}

void CellNumbers::grow() {
  slots_.assign(2 * slots_.size(), kNone);
  for (std::uint32_t i = 0; i < cells_.size(); ++i) find(cells_[i]) = i;
}

}  // namespace tess::collide::serial
