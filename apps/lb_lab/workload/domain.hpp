// The cells of a workload and how they are cut among elements. All cuts have the same cells, hence
// the same work and the same answer: a PE's share in 1 or in 32 chares.
//
//     ┌──┬──┬──┐   width × height cells; element e has the block (e mod columns, e / columns).
//     ├──┼──┼──┤   Sizes of blocks differ by at most one cell on each axis.
//     └──┴──┴──┘
#pragma once

#include <array>
#include <cstdint>

namespace lb_lab {

struct Cell {
  std::int32_t x = 0, y = 0;
};

enum class Side : std::uint8_t { west, east, south, north };
inline constexpr std::array<Side, 4> all_sides{Side::west, Side::east, Side::south, Side::north};
[[nodiscard]] constexpr Side opposite(Side side) {
  constexpr std::array<Side, 4> of{Side::east, Side::west, Side::north, Side::south};
  return of[static_cast<std::size_t>(side)];
}

/// Cells first.x … first.x + width − 1, and so in y.
struct Block {
  Cell first;
  std::int32_t width = 0, height = 0;
};

struct Domain {
  std::int32_t width = 1, height = 1;  ///< cells
  std::int32_t columns = 1, rows = 1;  ///< blocks

  [[nodiscard]] std::int64_t n_cells() const { return std::int64_t{width} * height; }
  [[nodiscard]] std::int32_t n_elements() const { return columns * rows; }
  [[nodiscard]] Block block(std::int32_t element) const;
  /// The element across a side, or −1 at the border.
  [[nodiscard]] std::int32_t neighbour(std::int32_t element, Side side) const;
  /// Row-major number of a cell: names it in hashes.
  [[nodiscard]] std::uint64_t number(Cell cell) const {
    return static_cast<std::uint64_t>(cell.y) * static_cast<std::uint64_t>(width) +
           static_cast<std::uint64_t>(cell.x);
  }
};

/// A row of n cells.
[[nodiscard]] Domain line_of(std::int32_t n_cells);
/// A plane of n × 4 cells, as square as the divisors of n allow: each of n blocks has 2 × 2.
[[nodiscard]] Domain plane_of(std::int32_t n_blocks);

/// The domain cut into n elements, with the shortest borders that n allows. Throws tess::Error
/// where a cut into n has an empty block.
[[nodiscard]] Domain cut(Domain domain, std::int32_t n_elements);

}  // namespace lb_lab
