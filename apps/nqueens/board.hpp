// The n queens problem without messages: boards as bit masks, rows filled from the first. Attacked
// squares of the next row are three masks, which move by a bit from row to row:
//
//     row 0   . Q . .      columns 0010   the Q at column 1 attacks column 1 …
//     row 1   x x x .      left    0100   … and the diagonals to both sides
//     row 2                right   0001
//
// A board is named by its path, the columns of its queens from the first row on, `column_bits`
// each, from the highest bit down: smaller paths stand further left in the tree of all boards.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nqueens {

inline constexpr std::int32_t most_queens = 20;
inline constexpr std::int32_t column_bits = 5;
inline constexpr std::int32_t most_path_rows = 12;  ///< 60 bits: a path is a priority as well

struct Board {
  std::uint32_t columns = 0, left = 0, right = 0;  ///< attacked squares of row `row`
  std::int32_t row = 0;                            ///< queens placed
  std::int64_t path = 0;                           ///< of the first most_path_rows rows

  /// The board with one more queen, at the column of `bit`.
  [[nodiscard]] Board with(std::uint32_t bit) const;
  /// The columns of the next row that no queen attacks.
  [[nodiscard]] std::uint32_t free(std::int32_t n) const {
    return ((std::uint32_t{1} << static_cast<std::uint32_t>(n)) - 1) & ~(columns | left | right);
  }
  friend bool operator==(const Board&, const Board&) = default;
};

/// The column of the queen in each row.
using Solution = std::array<std::uint8_t, most_queens>;

struct Count {
  std::uint64_t n_solutions = 0;
  std::uint64_t n_boards = 0;  ///< boards looked at, the first one included
};

/// The boards with so many queens, from left to right. All above them are added to `n_boards`.
[[nodiscard]] std::vector<Board> boards_of_row(std::int32_t row, std::int32_t n,
                                               std::uint64_t& n_boards);

/// All solutions below a board.
[[nodiscard]] Count count_below(const Board& board, std::int32_t n);

/// The solution below a board whose path is the smallest. Boards that it looked at are added to
/// `n_boards`.
[[nodiscard]] std::optional<Solution> first_below(const Board& board, std::int32_t n,
                                                  std::uint64_t& n_boards);

/// False if two queens attack each other.
[[nodiscard]] bool is_solution(const Solution& queens, std::int32_t n);

/// The known number of solutions (OEIS A000170), 1 to most_queens queens.
[[nodiscard]] std::uint64_t known_count(std::int32_t n);

/// "1 3 0 2".
[[nodiscard]] std::string to_text(const Solution& queens, std::int32_t n);

}  // namespace nqueens
