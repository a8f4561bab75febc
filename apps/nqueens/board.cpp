#include "apps/nqueens/board.hpp"

#include "runtime/core/text.hpp"

#include <bit>
#include <cstdlib>
#include <utility>

namespace nqueens {
namespace {

void count(std::uint32_t all, std::uint32_t columns, std::uint32_t left, std::uint32_t right,
           Count& total) {
  ++total.n_boards;
  if (columns == all) ++total.n_solutions;
  for (std::uint32_t free = all & ~(columns | left | right); free != 0; free &= free - 1) {
    const std::uint32_t bit = free & -free;
    count(all, columns | bit, (left | bit) << 1U, (right | bit) >> 1U, total);
  }
}

bool find(const Board& board, std::int32_t n, Solution& queens, std::uint64_t& n_boards) {
  ++n_boards;
  if (board.row == n) return true;
  for (std::uint32_t free = board.free(n); free != 0; free &= free - 1) {
    const std::uint32_t bit = free & -free;
    queens[static_cast<std::size_t>(board.row)] = static_cast<std::uint8_t>(std::countr_zero(bit));
    if (find(board.with(bit), n, queens, n_boards)) return true;
  }
  return false;
}

}  // namespace

Board Board::with(std::uint32_t bit) const {
  Board next{columns | bit, (left | bit) << 1U, (right | bit) >> 1U, row + 1, path};
  if (row < most_path_rows)
    next.path |= std::int64_t{std::countr_zero(bit)} << (column_bits * (most_path_rows - 1 - row));
  return next;
}

std::vector<Board> boards_of_row(std::int32_t row, std::int32_t n, std::uint64_t& n_boards) {
  std::vector<Board> boards{Board()};
  for (; row > 0; --row) {
    n_boards += boards.size();
    std::vector<Board> next;
    for (const Board& board : boards)
      for (std::uint32_t free = board.free(n); free != 0; free &= free - 1)
        next.push_back(board.with(free & -free));
    boards = std::move(next);
  }
  return boards;
}

Count count_below(const Board& board, std::int32_t n) {
  Count total;
  count((std::uint32_t{1} << static_cast<std::uint32_t>(n)) - 1, board.columns, board.left,
        board.right, total);
  return total;
}

std::optional<Solution> first_below(const Board& board, std::int32_t n, std::uint64_t& n_boards) {
  Solution queens{};
  for (std::int32_t row = 0; row < board.row && row < most_path_rows; ++row)
    queens[static_cast<std::size_t>(row)] = static_cast<std::uint8_t>(
        (board.path >> (column_bits * (most_path_rows - 1 - row))) & ((1 << column_bits) - 1));
  if (find(board, n, queens, n_boards)) return queens;
  return std::nullopt;
}

bool is_solution(const Solution& queens, std::int32_t n) {
  for (std::int32_t a = 0; a < n; ++a) {
    const int of_a = queens[static_cast<std::size_t>(a)];
    if (of_a >= n) return false;
    for (std::int32_t b = a + 1; b < n; ++b) {
      const int apart = std::abs(of_a - queens[static_cast<std::size_t>(b)]);
      if (apart == 0 || apart == b - a) return false;
    }
  }
  return true;
}

std::uint64_t known_count(std::int32_t n) {
  constexpr std::array<std::uint64_t, most_queens> counts{
      1,    0,     0,     2,      10,      4,        40,       92,        352,        724,
      2680, 14200, 73712, 365596, 2279184, 14772512, 95815104, 666090624, 4968057848, 39029188884};
  return counts.at(static_cast<std::size_t>(n - 1));
}

std::string to_text(const Solution& queens, std::int32_t n) {
  std::string text;
  for (std::int32_t row = 0; row < n; ++row)
    text = tess::text(text, row > 0 ? " " : "", int{queens[static_cast<std::size_t>(row)]});
  return text;
}

}  // namespace nqueens
