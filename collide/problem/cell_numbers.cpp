#include "collide/problem/cell_numbers.hpp"

namespace tess::collide::search {

CellNumbers::CellNumbers(const CellRange& range, double n_used) : low_(range.lo) {
  if (range.n_cells() <= 2 * n_used + 64) {
    n_y_ = std::int64_t{range.hi.y} - range.lo.y + 1;
    n_z_ = std::int64_t{range.hi.z} - range.lo.z + 1;
    n_dense_ = static_cast<std::size_t>(range.n_cells());
    return;
  }
  std::size_t n = 64;
  while (static_cast<double>(n) < n_used / 4) n *= 2;
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

}  // namespace tess::collide::search
