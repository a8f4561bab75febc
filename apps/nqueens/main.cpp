// nqueens: how many ways are there to put n queens on a board of n × n squares such that none
// attacks another? A tree search in messages with priorities, checked against the known counts.
#include "apps/kit/driver.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "apps/nqueens/parts.hpp"
#include "apps/nqueens/report.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <optional>

namespace nqueens {
namespace {

struct Options {
  Problem problem;
  std::optional<std::int32_t> grain;
  std::optional<std::uint64_t> expected;
  std::string form = "group", priority = "path";
  std::int32_t repeat = 1;
  kit::Checkpoints checkpoints;
};

/// One problem, or with --study each grain in both forms; the first of a study is one task.
std::vector<Problem> problems_of(const Options& options, bool study) {
  if (!study) return {options.problem};
  std::vector<Problem> all;
  for (const Form form : {Form::group, Form::chares}) {
    Problem problem = options.problem;
    problem.form = form;
    for (std::int32_t rows = 0; rows <= std::min(problem.n - 1, 7); ++rows) {
      problem.grain = problem.n - rows;
      all.push_back(problem);
    }
  }
  return all;
}

std::uint64_t expected_of(const Options& options, const Row& row) {
  return options.expected.value_or(known_count(row.problem.n));
}

tess::Task measure(Options options, kit::Driver& driver) {
  kit::Progress& progress = driver.progress();
  const bool study = driver.mode() == kit::Mode::study;
  progress.phase("searching");
  const std::vector<Problem> problems = problems_of(options, study);
  std::vector<Row> rows;
  tess::print_text(tess::machine().describe() + "\n" + report().head());
  for (const Problem& problem : problems) {
    progress.part(rows.size() + 1, problems.size());
    Row row{.problem = problem, .outcome = {}};
    for (std::int32_t k = 0; k < options.repeat; ++k) {
      Outcome outcome;
      if (options.checkpoints.are_used())
        co_await search_in_parts(row.problem, options.grain, options.expected, options.checkpoints,
                                 outcome);
      else
        co_await search(problem, outcome);
      const bool wrong = !fault({row.problem, outcome}, expected_of(options, row)).empty();
      if (k == 0 || wrong || outcome.seconds < row.outcome.seconds) row.outcome = outcome;
      if (wrong) break;  // it is not repeated away
    }
    rows.push_back(row);
    if (study)
      rows.back().efficiency = rows.front().outcome.seconds / (tess::n_pes() * row.outcome.seconds);
    progress.clear();
    tess::print_text(report().line(rows.back()));
    if (const std::string why = fault(row, expected_of(options, row)); !why.empty()) {
      kit::end_with("nqueens: wrong answer: " + why);
      co_return;
    }
  }
  driver.write(report().json(rows));
  if (study) driver.draw(chart_of(rows));
}

int run(tess::Setup& setup, int argc, char** argv) {
  Options options;
  Problem& problem = options.problem;
  using kit::Mode;
  kit::Driver driver(setup,
                     "Counts the solutions of the n queens problem by a search in messages.");
  driver.option("N", problem.n, "queens").between(1, most_queens);
  driver
      .option("--priority", options.priority,
              "path: boards on the left first, so depth first; none: as they come, breadth first")
      .one_of({"path", "none"});
  driver.option("--expect", options.expected,
                "exit with 1 unless there are so many solutions (default: the known number)");
  driver.repeat(options.repeat);
  driver.json();
  driver.in(Mode::run);  // a study tries all grains and both forms, and counts
  driver
      .option("--grain", options.grain,
              "boards with at most so many rows left are searched serially (default: N - 4)")
      .between(1, most_queens);
  driver
      .option("--form", options.form,
              "group: tasks are messages to PEs; chares: each task is a chare created on demand")
      .one_of({"group", "chares"});
  driver.flag("--first", problem.first, "find the first solution only, in the order of columns");
  options.checkpoints.add_options(driver);
  driver.in(Mode::study);
  driver.study("every grain in both forms: time, tasks, efficiency");
  driver.picture("draw the rows");
  if (!driver.parse(argc, argv)) return 0;
  for (const char* option : {"--checkpoint", "--restart"}) driver.refuse_both(option, "--repeat");
  options.checkpoints.check(driver.line(), {"N", "--first"});
  problem.prioritised = options.priority == "path";
  problem.form = options.form == "group" ? Form::group : Form::chares;
  problem.grain = options.grain.value_or(default_grain(problem.n));
  if (!options.checkpoints.restarts()) check_grain(problem);  // otherwise N is in the checkpoint
  check_expected(problem, options.expected);
  return tess::run(setup, [&] { return measure(options, driver); });
}

}  // namespace
}  // namespace nqueens

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return nqueens::run(setup, argc, argv); });
}
