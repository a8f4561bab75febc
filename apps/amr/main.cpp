// amr: a field that is carried through a periodic cube, on an oct-tree of blocks that follows it.
#include "apps/amr/report.hpp"
#include "apps/amr/stability.hpp"
#include "apps/kit/driver.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace amr {
namespace {

struct Options {
  Settings settings;
  bool uncorrected = false;
};

/// One run, or with --study each order with each greatest level, and uniform trees.
std::vector<Settings> runs_of(const Options& options, bool study) {
  if (!study) return {options.settings};
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

tess::Task run_all(Options options, kit::Driver& driver) {
  kit::Progress& progress = driver.progress();
  const bool study = driver.mode() == kit::Mode::study;
  std::vector<Row> rows;
  tess::print_text(tess::machine().describe() + "\n" + report().head());
  for (Settings& settings : runs_of(options, study)) {
    progress.phase("planting the tree");
    Outcome outcome;
    co_await simulate(settings, outcome, [&](std::int32_t step) {
      progress.phase("steps");
      progress.part(step + 1, settings.problem.n_steps);
    });
    progress.clear();
    rows.push_back({settings, outcome});
    tess::print_text(report().line(rows.back()));
    if (const std::string why = fault(outcome); !why.empty()) {
      kit::end_with("amr: wrong answer: " + why);
      co_return;
    }
  }
  if (!study)
    tess::print_text(fmt::format("result_hash {:016x}\n", rows.front().outcome.end.norms.hash));
  driver.write(report().json(rows));
  if (study) driver.draw(chart_of(rows));
}

tess::Task check_stability(bool corrected, kit::Driver& driver) {
  kit::Cases<> cases;
  co_await run_stability(corrected, cases);
  if (const int code = cases.finish(driver); code != 0) tess::exit(code);
}

int start(tess::Setup& setup, int argc, char** argv) {
  Options options;
  Settings& settings = options.settings;
  Problem& problem = settings.problem;
  std::vector<double> velocity(problem.velocity.begin(), problem.velocity.end());
  std::vector<double> centre(problem.centre.begin(), problem.centre.end());
  std::string balance;
  using kit::Mode;
  kit::Driver driver(
      setup, "Advection of a Gaussian on an oct-tree of blocks, each a chare, that follows it.");
  driver.in(Mode::run | Mode::study);
  driver.option("--max-level", problem.most_level, "finest blocks: edge 2^-N").between(0, 8);
  driver.option("--least-level", problem.least_level, "coarsest blocks").between(0, 5);
  driver.option("--cells", problem.n_cells, "cells of a block along each axis, even")
      .between(4, 64);
  driver.option("--cfl", problem.cfl, "of the finest cells, at most 1");
  driver.option("--time", problem.end, "time at the end").positive();
  driver.option("--steps", problem.n_steps, "instead of --time").between(1, most_steps);
  driver.option("--width", problem.width, "standard deviation of the Gaussian").positive();
  driver.option("--velocity VX,VY,VZ", velocity, "of the flow").separated_by(',').takes(3, 3);
  driver.option("--centre X,Y,Z", centre, "of the Gaussian at time 0")
      .separated_by(',')
      .takes(3, 3);
  driver
      .option("--refine", problem.refine,
              "difference of two cells that refines a block; below a quarter of it blocks merge")
      .positive();
  driver.option("--change-every", settings.change_every, "steps between changes of the tree")
      .between(1, 1'000'000);
  driver.option("--balance STRATEGY", balance,
                "balance after each change: a strategy, as "
                "greedy_refine[,prediction=…][,report]");
  driver.json();
  driver.in(Mode::run);
  driver.option("--order", problem.order, "of the scheme").between(1, 3);
  settings.checkpoints.add_options(driver);
  driver.in(Mode::study);
  driver.study("orders 1 to 3 with each greatest level, and uniform trees: error against run time");
  driver.picture("draw the rows");
  driver.in(Mode::all);
  driver.stability("cases at the edge, each against what must hold");
  driver.flag("--uncorrected", options.uncorrected,
              "coarse cells keep their own flows beside finer ones: the mass changes, exit code 1");
  driver.examples({"--max-level 4 --steps 8 --pes 2",
                   "--max-level 4 --steps 8 --balance greedy_refine --sim pes=8,cost=100ns",
                   "--max-level 4 --steps 4 --study"});
  if (!driver.parse(argc, argv)) return 0;
  driver.refuse_both("--steps", "--time");
  settings.checkpoints.check(driver.line(), {"--max-level", "--least-level", "--cells", "--order",
                                             "--cfl", "--time", "--width", "--velocity", "--centre",
                                             "--refine", "--change-every", "--uncorrected"});
  std::ranges::copy(velocity, problem.velocity.begin());
  std::ranges::copy(centre, problem.centre.begin());
  problem.corrected = !options.uncorrected;
  if (!settings.checkpoints.restarts()) problem.complete();  // otherwise it is in the checkpoint
  if (driver.is_given("--balance")) {
    settings.balance = tess::parse_balance(balance);
    if (settings.balance->when == tess::BalanceWhen::periodic)
      tess::fail(tess::ErrorCode::bad_argument, "--balance ", balance,
                 ": rounds run after changes of the tree; leave out when=periodic");
  }
  return tess::run(setup, [&] {
    return driver.mode() == Mode::stability ? check_stability(problem.corrected, driver)
                                            : run_all(options, driver);
  });
}

}  // namespace
}  // namespace amr

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return amr::start(setup, argc, argv); });
}
