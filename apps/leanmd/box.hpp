// The periodic box: a cube, cut into cells. A coordinate counts the edge of the box in units of
// 2^-64. So it wraps round by itself where an atom leaves the box, and the difference of two
// coordinates, read as a signed number, leads to the nearest image. Both are exact.
#pragma once

#include "runtime/core/index.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace leanmd {

using Position = std::array<std::uint64_t, 3>;
using Vector = std::array<std::int64_t, 3>;

struct Box {
  double edge = 1;
  std::array<std::int32_t, 3> n_cells{1, 1, 1};

  [[nodiscard]] double least_cell_edge() const {
    return edge / *std::max_element(n_cells.begin(), n_cells.end());
  }
  [[nodiscard]] tess::Index3 cell_of(const Position& at) const {
    return {slice(at, 0), slice(at, 1), slice(at, 2)};
  }

  /// The cells with a point within `distance` of a point of this cell: itself and its neighbours,
  /// each once, however few there are around the box.
  [[nodiscard]] std::vector<tess::Index3> cells_within(double distance, tess::Index3 cell) const {
    const auto reach = [&](std::size_t axis) {
      return static_cast<std::int32_t>(std::ceil(distance / edge * n_cells[axis]));
    };
    return cells_around(cell, {reach(0), reach(1), reach(2)});
  }
  /// The cell and those that touch it.
  [[nodiscard]] std::vector<tess::Index3> cells_touching(tess::Index3 cell) const {
    return cells_around(cell, {1, 1, 1});
  }

 private:
  [[nodiscard]] std::int32_t slice(const Position& at, std::size_t axis) const {
    __extension__ using Wide = unsigned __int128;
    return static_cast<std::int32_t>(Wide{at[axis]} * static_cast<Wide>(n_cells[axis]) >> 64U);
  }
  [[nodiscard]] std::vector<tess::Index3> cells_around(tess::Index3 cell,
                                                       std::array<std::int32_t, 3> reach) const {
    const auto wrapped = [&](std::int32_t at, std::size_t axis) {
      return (at % n_cells[axis] + n_cells[axis]) % n_cells[axis];
    };
    std::vector<tess::Index3> cells;
    for (std::int32_t x = cell.x - reach[0]; x <= cell.x + reach[0]; ++x)
      for (std::int32_t y = cell.y - reach[1]; y <= cell.y + reach[1]; ++y)
        for (std::int32_t z = cell.z - reach[2]; z <= cell.z + reach[2]; ++z)
          cells.push_back({wrapped(x, 0), wrapped(y, 1), wrapped(z, 2)});
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }
};

/// The index of what two cells have in common: the same for (a, b) and (b, a).
[[nodiscard]] inline tess::Index6 pair_of(tess::Index3 a, tess::Index3 b) {
  if (b < a) std::swap(a, b);
  return {{a.x, a.y, a.z, b.x, b.y, b.z}};
}
/// One if the pair is a cell and itself, otherwise two.
[[nodiscard]] inline std::size_t n_cells_of(const tess::Index6& pair) {
  const auto& x = pair.x;
  return x[0] == x[3] && x[1] == x[4] && x[2] == x[5] ? 1 : 2;
}

}  // namespace leanmd
