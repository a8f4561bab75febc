// amr: a field that is carried through a periodic cube, on an oct-tree of blocks that follows it.
#include "apps/amr/report.hpp"
#include "apps/amr/stability.hpp"
#include "apps/progress.hpp"
#include "apps/row_files.hpp"
#include "apps/wrong_answer.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace amr {
namespace {

struct Options {
  Settings settings;
  apps::RowFiles files;
  bool study = false, stability = false, uncorrected = false;
};

/// One run, or with --study each order with each greatest level, and uniform trees.
std::vector<Settings> runs_of(const Options& options) {
  if (!options.study) return {options.settings};
  std::vector<Settings> all;
  const Problem& given = options.settings.problem;
  for (const bool uniform : {false, true})
    for (const std::int32_t order : {1, 2, 3})
      for (std::int32_t level = given.least_level; level <= given.most_level; ++level) {
        if (uniform && (order != 2 || level == given.least_level)) continue;
        Settings one = options.settings;
        one.problem.order = order;
        one.problem.most_level = level;
        if (uniform) one.problem.least_level = level;
        // Differences within a block fall with the spacing, and the scheme's errors with its
        // square.
        for (std::int32_t k = given.least_level + 1; k < level; ++k) one.problem.refine /= 4;
        one.problem.n_steps = 0;  // by the time and this level
        one.problem.complete();
        all.push_back(one);
      }
  return all;
}

tess::Task run_all(Options options) {
  apps::Progress progress(stderr);
  std::vector<Settings> runs = runs_of(options);
  std::vector<Row> rows;
  tess::print_text(tess::machine().describe() + "\n" + head());
  for (Settings& settings : runs) {
    progress.phase("planting the tree");
    Outcome outcome;
    co_await simulate(settings, outcome, [&](std::int32_t step) {
      progress.phase("steps");
      progress.part(step + 1, settings.problem.n_steps);
    });
    progress.clear();
    rows.push_back({settings, outcome});
    tess::print_text(line(rows.back()));
    if (const std::string why = fault(outcome); !why.empty()) {
      apps::end_with("amr: wrong answer: " + why);
      co_return;
    }
  }
  if (!options.study)
    tess::print_text(fmt::format("result_hash {:016x}\n", rows.front().outcome.end.norms.hash));
  options.files.write(json_of(rows), chart_of(rows));
}

tess::Task check_stability(Options options) {
  std::vector<StabilityRow> rows;
  co_await run_stability(!options.uncorrected, rows, [](const StabilityRow& row) {
    tess::print_text(fmt::format("{:<6} {}: {}; {}\n", row.holds ? "ok" : "FAILED", row.name,
                                 row.expected, row.found));
  });
  std::size_t n_failed = 0;
  for (const StabilityRow& row : rows) n_failed += row.holds ? 0 : 1;
  tess::print_text(fmt::format("{} of {} cases hold\n", rows.size() - n_failed, rows.size()));
  if (n_failed > 0) tess::exit(1);
}

int start(tess::Setup& setup, int argc, char** argv) {
  Options options;
  Settings& settings = options.settings;
  Problem& problem = settings.problem;
  std::vector<double> velocity(problem.velocity.begin(), problem.velocity.end());
  std::vector<double> centre(problem.centre.begin(), problem.centre.end());
  std::string balance;
  tess::CommandLine line(
      "Advection of a Gaussian on an oct-tree of blocks, each a chare, that follows it.");
  line.option("--max-level", problem.most_level, "finest blocks: edge 2^-N").between(0, 8);
  line.option("--least-level", problem.least_level, "coarsest blocks").between(0, 5);
  line.option("--cells", problem.n_cells, "cells of a block along each axis, even").between(4, 64);
  line.option("--order", problem.order, "of the scheme").between(1, 3);
  line.option("--cfl", problem.cfl, "of the finest cells, at most 1");
  line.option("--time", problem.end, "time at the end").positive();
  line.option("--steps", problem.n_steps, "instead of --time").between(1, most_steps);
  line.option("--width", problem.width, "standard deviation of the Gaussian").positive();
  line.option("--velocity VX,VY,VZ", velocity, "of the flow").separated_by(',').takes(3, 3);
  line.option("--centre X,Y,Z", centre, "of the Gaussian at time 0").separated_by(',').takes(3, 3);
  line.option("--refine", problem.refine,
              "difference of two cells that refines a block; below a quarter of it blocks merge")
      .positive();
  line.option("--change-every", settings.change_every, "steps between changes of the tree")
      .between(1, 1'000'000);
  line.option("--balance STRATEGY", balance,
              "balance after each change: a strategy, as greedy_refine[,prediction=…][,report]");
  line.flag("--uncorrected", options.uncorrected,
            "coarse cells keep their own flows beside finer ones: the mass changes, exit code 1");
  line.flag("--study", options.study,
            "orders 1 to 3 with each greatest level, and uniform trees: error against run time");
  line.flag("--stability", options.stability, "cases at the edge, each against what must hold");
  options.files.add_options(line);
  settings.checkpoints.add_options(line);
  if (!line.parse(argc, argv)) return 0;
  settings.checkpoints.check(
      line, {"--max-level", "--least-level", "--cells", "--order", "--cfl", "--time", "--width",
             "--velocity", "--centre", "--refine", "--change-every", "--uncorrected"});
  if (line.is_given("--steps") && line.is_given("--time"))
    tess::refuse_together("--steps " + line.value("--steps"), "--time " + line.value("--time"));
  std::ranges::copy(velocity, problem.velocity.begin());
  std::ranges::copy(centre, problem.centre.begin());
  problem.corrected = !options.uncorrected;
  if (!settings.checkpoints.restarts()) problem.complete();  // else it is in the checkpoint
  if (line.is_given("--balance")) {
    settings.balance = tess::parse_balance(balance);
    if (settings.balance->when == tess::BalanceWhen::periodic)
      tess::fail(tess::ErrorCode::bad_argument, "--balance ", balance,
                 ": rounds run after changes of the tree; leave out when=periodic");
  }
  if (options.study && options.stability)
    tess::fail(tess::ErrorCode::bad_argument, "--study and --stability: choose one");
  if ((options.study || options.stability) && settings.checkpoints.are_used())
    tess::fail(tess::ErrorCode::bad_argument,
               "--checkpoint and --restart: not for --study and --stability");
  if (options.study) line.refuse_beside("--study", {"--order"});
  if (options.stability)  // its cases have their own problems
    line.refuse_beside(
        "--stability",
        {"--max-level", "--least-level", "--cells", "--order", "--cfl", "--time", "--steps",
         "--width", "--velocity", "--centre", "--refine", "--change-every", "--balance", "--json"});
  options.files.check(options.study, setup.options.trace);
  return tess::run(setup,
                   [&] { return options.stability ? check_stability(options) : run_all(options); });
}

}  // namespace
}  // namespace amr

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return amr::start(setup, argc, argv); });
}
