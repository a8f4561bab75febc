// The search as messages. A task is a board: with more than `grain` rows left its entry method
// sends one task per queen of the next row, otherwise it searches all below it serially. Nothing
// waits: the end of the epoch is the end of the search, and then the counts are added.
//
//     form group    tasks are messages to the members of a group; a hash of the board chooses the PE
//     form chares   each task is a chare of a sparse array, created on demand at the home of its
//                   index, and destroyed when it has run
//
// What is looked for is the number of solutions, or the first solution, of the smallest path. Then
// a member that finds one sends it to all others before all other messages, and tasks to its right
// are dropped where they arrive.
#pragma once

#include "apps/nqueens/board.hpp"
#include "runtime/task.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace nqueens {

enum class Form : std::uint8_t { group, chares };

struct Problem {
  std::int32_t n = 12;
  std::int32_t grain = 8;   ///< boards with at most so many rows left are searched serially
  bool first = false;       ///< the first solution is enough
  bool prioritised = true;  ///< boards on the left first: depth first; otherwise breadth first
  Form form = Form::group;
};

[[nodiscard]] inline std::int32_t default_grain(std::int32_t n) {
  return std::max(n - 4, 1);
}
/// Throws tess::Error for a grain that leaves more rows than a path has.
void check_grain(const Problem& problem);
/// Throws tess::Error for an expected number of solutions where only the first is looked for.
void check_expected(const Problem& problem, std::optional<std::uint64_t> expected);

/// What is known at the end, on all PEs.
struct Outcome {
  Count count;
  std::uint64_t n_tasks = 0;    ///< messages that carried a board
  std::uint64_t n_dropped = 0;  ///< of them, those to the right of a solution that was known
  std::uint64_t hash = 0;  ///< of the count, or of the first solution; the same for every grain
  bool found = false;      ///< with `first`: there is a solution
  Solution solution{};
  double seconds = 0;

  /// Adds what is known of another part of the tree, but the hash.
  void add(const Outcome& part);
};

/// Searches all below these boards on all PEs, by default below the empty one, and adds what it
/// finds to `outcome`. Called on one PE, in the main coroutine.
tess::Task search(Problem problem, Outcome& outcome, std::vector<Board> boards);
tess::Task search(Problem problem, Outcome& outcome);

}  // namespace nqueens
