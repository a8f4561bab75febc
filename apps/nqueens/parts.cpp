#include "apps/nqueens/parts.hpp"

#include <algorithm>

namespace nqueens {
namespace {

struct State {
  std::int32_t n = 0;
  bool first = false;
  std::int32_t step = 0;  ///< parts that are done
  Outcome outcome;        ///< theirs, and the boards above all parts
};

}  // namespace

tess::Task search_in_parts(Problem& problem, std::optional<std::int32_t> grain,
                           std::optional<std::uint64_t> expected, kit::Checkpoints& checkpoints,
                           Outcome& outcome) {
  State state{problem.n, problem.first, 0, {}};
  std::int32_t n_parts = 0;
  if (checkpoints.restarts()) {
    co_await checkpoints.restart(state, n_parts);
    problem.n = state.n;
    problem.grain = grain.value_or(default_grain(state.n));
    check_grain(problem);
    problem.first = state.first;
    check_expected(problem, expected);
  }
  std::uint64_t n_above = 0;
  const std::vector<Board> parts = boards_of_row(std::min(problem.n - 1, 3), problem.n, n_above);
  n_parts = static_cast<std::int32_t>(parts.size());
  if (!checkpoints.restarts()) state.outcome.count.n_boards = n_above;
  while (state.step < n_parts && !(problem.first && state.outcome.found)) {
    const std::int32_t from = state.step;
    state.step = checkpoints.pause_after(from, n_parts);
    const std::vector<Board> some(parts.begin() + from, parts.begin() + state.step);
    co_await search(problem, state.outcome, some);
    co_await checkpoints.save_if_due(state, from, n_parts);
  }
  outcome = state.outcome;
}

}  // namespace nqueens
