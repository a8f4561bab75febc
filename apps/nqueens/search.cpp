#include "apps/nqueens/search.hpp"

#include "apps/kit/charge.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/runtime.hpp"

#include <chrono>
#include <limits>

namespace nqueens {
namespace {

constexpr std::chrono::nanoseconds per_board{6};  // as measured

/// The index of a task's chare: one per board.
struct Place {
  std::int64_t path = 0;
  std::int64_t row = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

/// A solution, and the path of the task that found it.
struct Found {
  std::int64_t path = std::numeric_limits<std::int64_t>::max();
  Solution queens{};
};

struct Tally {
  Outcome outcome;
  Found found;
};
struct Join {
  Tally operator()(const Tally& a, const Tally& b) const {
    Tally all = a;
    all.outcome.add(b.outcome);
    if (b.found.path < a.found.path) all.found = b.found;
    return all;
  }
};

class Branch;

/// The part of a PE in the search: it runs tasks and adds up.
class Searcher : public tess::Group<Searcher> {
 public:
  explicit Searcher(const Problem& problem) : problem_(problem) {}

  void use(tess::ArrayProxy<Branch> branches) { branches_ = branches; }
  void run(Board board);
  /// Another member knows a solution.
  void learn(const Found& found) {
    if (found.path < best_.path) best_ = found;
  }
  void report(const tess::Callback<Tally>& total) {
    contribute(Join(), Tally{tally_, best_}, total);
  }

 private:
  void send(const Board& board) const;
  void search_serially(const Board& board);

  Problem problem_;
  tess::ArrayProxy<Branch> branches_;
  Outcome tally_;
  Found best_;
};

/// A task as a chare, for the form `chares`. It knows its group by its first message.
class Branch : public tess::Chare<Branch, Place> {
 public:
  void run(tess::GroupProxy<Searcher> searchers, Board board) {
    searchers.local().run(board);
    destroy();
  }
};

void Searcher::run(Board board) {
  ++tally_.n_tasks;
  if (board.path > best_.path) {
    ++tally_.n_dropped;
  } else if (problem_.n - board.row <= problem_.grain) {
    search_serially(board);
  } else {
    ++tally_.count.n_boards;
    kit::charge(per_board, 1);
    for (std::uint32_t free = board.free(problem_.n); free != 0; free &= free - 1)
      send(board.with(free & -free));
  }
}

void Searcher::send(const Board& board) const {
  const tess::Priority priority{problem_.prioritised ? board.path : 0};
  if (problem_.form == Form::chares) {
    const auto branch = branches_[{board.path, board.row}];
    if (problem_.prioritised)
      branch.with(priority).send_or_create_home<&Branch::run>(group(), board);
    else
      branch.send_or_create_home<&Branch::run>(group(), board);
  } else {
    const auto n_pes = static_cast<std::uint64_t>(tess::n_pes());
    const std::uint64_t hash = tess::mix(static_cast<std::uint64_t>(board.path + board.row));
    const auto member = group()[tess::PeId{static_cast<std::int32_t>((hash >> 32U) % n_pes)}];
    if (problem_.prioritised)
      member.with(priority).send<&Searcher::run>(board);
    else
      member.send<&Searcher::run>(board);
  }
}

void Searcher::search_serially(const Board& board) {
  if (problem_.first) {
    const std::uint64_t n_before = tally_.count.n_boards;
    const auto queens = first_below(board, problem_.n, tally_.count.n_boards);
    kit::charge(per_board, tally_.count.n_boards - n_before);
    if (queens) {
      best_ = {board.path, *queens};
      group().with(tess::expedited).broadcast<&Searcher::learn>(best_);
    }
  } else {
    const Count below = count_below(board, problem_.n);
    tally_.count.n_solutions += below.n_solutions;
    tally_.count.n_boards += below.n_boards;
    kit::charge(per_board, below.n_boards);
  }
}

}  // namespace

void check_grain(const Problem& problem) {
  if (problem.n - problem.grain > most_path_rows)
    tess::fail(tess::ErrorCode::bad_argument, "--grain: ", problem.grain, " of ", problem.n,
               " rows leaves more than ", most_path_rows, " for tasks: give at least ",
               problem.n - most_path_rows);
}

void check_expected(const Problem& problem, std::optional<std::uint64_t> expected) {
  if (problem.first && expected.value_or(0) > 0)
    tess::fail(tess::ErrorCode::bad_argument, "--expect ", *expected,
               ": --first does not count; give --expect 0 if there is none, or leave one out");
}

void Outcome::add(const Outcome& part) {
  count.n_solutions += part.count.n_solutions;
  count.n_boards += part.count.n_boards;
  n_tasks += part.n_tasks;
  n_dropped += part.n_dropped;
  seconds += part.seconds;
  if (part.found) solution = part.solution;
  found = found || part.found;
}

tess::Task search(Problem problem, Outcome& outcome, std::vector<Board> boards) {
  tess::GroupProxy<Searcher> searchers;
  tess::ArrayProxy<Branch> branches;
  co_await tess::epoch([&] {
    searchers = tess::create<Searcher>(tess::each_pe, problem);
    branches = tess::create<Branch>(tess::sparse);
    searchers.broadcast<&Searcher::use>(branches);
  });
  const tess::Time begin = tess::now();
  co_await tess::epoch([&] {
    for (const Board& board : boards) searchers[tess::my_pe()].send<&Searcher::run>(board);
  });
  const double seconds = tess::seconds(tess::now() - begin);
  Tally tally = co_await searchers.reduce<&Searcher::report>();
  tally.outcome.seconds = seconds;
  tally.outcome.found = tally.found.path != std::numeric_limits<std::int64_t>::max();
  tally.outcome.solution = tally.found.queens;
  outcome.add(tally.outcome);
  outcome.hash = problem.first ? tess::hash_bytes(&outcome.solution, sizeof outcome.solution)
                               : tess::hash_bytes(&outcome.count, sizeof outcome.count);
  searchers.destroy();
  branches.destroy();
}

tess::Task search(Problem problem, Outcome& outcome) {
  return search(problem, outcome, std::vector<Board>(1));
}

}  // namespace nqueens
