// The serial search of nqueens.
#include "apps/nqueens/board.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

using namespace nqueens;

namespace {

/// All solutions by trying all permutations, in the order of their columns.
std::vector<Solution> all_by_trying(std::int32_t n) {
  std::vector<Solution> found;
  Solution queens{};
  std::iota(queens.begin(), queens.begin() + n, std::uint8_t{0});
  do {
    if (is_solution(queens, n)) found.push_back(queens);
  } while (std::next_permutation(queens.begin(), queens.begin() + n));
  return found;
}

}  // namespace

TEST_CASE("the serial search finds what trying all permutations finds", "[apps][nqueens]") {
  for (std::int32_t n = 1; n <= 8; ++n) {
    CAPTURE(n);
    const std::vector<Solution> all = all_by_trying(n);
    CHECK(count_below(Board(), n).n_solutions == all.size());
    CHECK(known_count(n) == all.size());
    std::uint64_t n_boards = 0;
    const auto first = first_below(Board(), n, n_boards);
    CHECK(first.has_value() == !all.empty());
    if (first && !all.empty()) CHECK(*first == all.front());
  }
}

TEST_CASE("a board's path orders boards from left to right, and is part of its solution",
          "[apps][nqueens]") {
  constexpr std::int32_t n = 9;
  std::int64_t before = -1;
  std::uint64_t n_solutions = 0;
  for (std::uint32_t free = Board().free(n); free != 0; free &= free - 1) {
    const Board one = Board().with(free & -free);
    for (std::uint32_t next = one.free(n); next != 0; next &= next - 1) {
      const Board two = one.with(next & -next);
      CHECK(two.path > before);
      CHECK(two.path >= one.path);
      before = two.path;
      n_solutions += count_below(two, n).n_solutions;
      std::uint64_t n_boards = 0;
      if (const auto queens = first_below(two, n, n_boards)) {
        CHECK(is_solution(*queens, n));
        CHECK(Board().with(1U << (*queens)[0]).with(1U << (*queens)[1]).path == two.path);
      }
    }
  }
  CHECK(n_solutions == known_count(n));
}

TEST_CASE("the boards of a row, and those above them, are the whole tree", "[apps][nqueens]") {
  for (const std::int32_t n : {1, 2, 4, 7}) {
    const Count whole = count_below(Board(), n);
    for (std::int32_t row = 0; row < n; ++row) {
      CAPTURE(n, row);
      Count sum;
      std::int64_t before = -1;
      for (const Board& board : boards_of_row(row, n, sum.n_boards)) {
        CHECK(board.row == row);
        CHECK(board.path > before);
        before = board.path;
        const Count below = count_below(board, n);
        sum.n_solutions += below.n_solutions;
        sum.n_boards += below.n_boards;
      }
      CHECK(sum.n_solutions == whole.n_solutions);
      CHECK(sum.n_boards == whole.n_boards);
    }
  }
}

TEST_CASE("queens in one column or diagonal are no solution", "[apps][nqueens]") {
  CHECK(is_solution({1, 3, 0, 2}, 4));
  CHECK_FALSE(is_solution({1, 3, 0, 0}, 4));
  CHECK_FALSE(is_solution({0, 1, 3, 2}, 4));
  CHECK_FALSE(is_solution({1, 3, 0, 4}, 4));
}
