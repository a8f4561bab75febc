// fsi: a flexible panel in the floor of a channel, and the fluid above it, on two meshes.
#include "apps/fsi/report.hpp"
#include "apps/kit/driver.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "runtime/runtime.hpp"

#include <fmt/format.h>

namespace fsi {
namespace {

/// One run; or with --study meshes and steps refined together.
std::vector<Settings> runs_of(const Settings& settings, bool study) {
  if (!study) return {settings};
  std::vector<Settings> all;
  for (const bool adapts : {true, false})
    for (const std::int32_t factor : {1, 2, 4}) {
      Settings one = settings;
      Problem& p = one.problem;
      p.n_panel = factor * p.n_panel / 2;
      p.n_steps = factor * p.n_steps / 2;
      p.per_period = factor * p.per_period / 2;
      p.n_flow = p.n_substeps = 0;
      p.adapts = adapts;
      p.complete(tess::n_pes());
      all.push_back(one);
    }
  return all;
}

tess::Task run_all(Settings given, kit::Driver& driver) {
  kit::Progress& progress = driver.progress();
  const bool study = driver.mode() == kit::Mode::study;
  if (!given.checkpoints.restarts() && !study) given.problem.complete(tess::n_pes());
  if (driver.explains()) tess::print_text(explanation(given));
  std::vector<Row> rows;
  tess::print_text(tess::machine().describe() + "\n" + report().head());
  for (Settings& settings : runs_of(given, study)) {
    Outcome outcome;
    progress.phase("steps");
    co_await simulate(settings, outcome, [&](std::int32_t step) {
      progress.part(step + 1, settings.problem.n_steps);
    });
    progress.clear();
    rows.push_back({settings.problem, outcome});
    tess::print_text(report().line(rows.back()));
    if (const std::string why = fault(outcome); !why.empty()) {
      kit::end_with("fsi: wrong answer: " + why);
      co_return;
    }
  }
  if (!study) tess::print_text(fmt::format("result_hash {:016x}\n", rows.front().outcome.hash));
  if (study) {
    const std::size_t n = rows.size() / 2;  // those with Aitken's factors come first
    if (const auto order =
            kit::order_between({1.0 / rows[n - 2].problem.n_panel, rows[n - 2].outcome.error},
                               {1.0 / rows[n - 1].problem.n_panel, rows[n - 1].outcome.error}))
      tess::print_text(fmt::format("order {:.2f} between the two finest meshes\n", *order));
  }
  driver.write(report().json(rows));
  if (study) driver.draw(chart_of(rows));
}

tess::Task check_stability(std::int32_t n_pieces, kit::Driver& driver) {
  kit::Cases<> cases;
  co_await run_stability(n_pieces, cases);
  if (const int code = cases.finish(driver); code != 0) tess::exit(code);
}

int start(tess::Setup& setup, int argc, char** argv) {
  Settings settings;
  Problem& problem = settings.problem;
  std::string balance;
  using kit::Mode;
  kit::Driver driver(
      setup, "A flexible panel in the floor of a channel, coupled with the fluid above it.");
  driver.option("--pieces", problem.n_pieces, "of each mesh (default: two per PE)").between(1, 512);
  driver.json();
  driver.in(Mode::run | Mode::study);
  driver.option("--panel", problem.n_panel, "squares on an edge of the panel's mesh")
      .between(4, 512);
  driver.option("--steps", problem.n_steps, "in which panel and fluid meet").between(4, 1'000'000);
  driver.option("--per-period", problem.per_period, "steps in a period of the motion")
      .between(8, 1'000'000);
  driver.option("--mass", problem.mass, "of the panel per area").positive();
  driver.option("--tension", problem.tension, "of the panel, force per length").positive();
  driver.option("--density", problem.density, "of the fluid").between(0, 1e9);
  driver.option("--height", problem.height, "of the channel, in edges of the panel").positive();
  driver.option("--relaxation", problem.relaxation, "factor of the first correction").positive();
  driver.option("--balance STRATEGY", balance,
                "pieces migrate between steps: a strategy, as greedy_refine");
  const tess::Option every =
      driver.option("--balance-every", settings.balance_every, "steps between rounds")
          .between(1, 1'000'000);
  driver.explain();
  driver.in(Mode::run);
  driver
      .option("--flow", problem.n_flow,
              "squares on an edge of the fluid's wall (default: half as many again as --panel)")
      .between(4, 512);
  driver
      .option("--substeps", problem.n_substeps,
              "of the panel in a step (default: as many as are stable)")
      .between(1, 1'000'000);
  bool one_factor = false;
  driver.flag("--no-aitken", one_factor,
              "all corrections have the factor of the first one: too much for light panels");
  settings.checkpoints.add_options(driver);
  driver.in(Mode::study);
  driver.study("half, once and twice as fine meshes and steps: error against run time");
  driver.picture("draw the rows");
  driver.in(Mode::all);
  driver.stability("light panels in dense fluids, each against what must hold");
  if (!driver.parse(argc, argv)) return 0;
  settings.checkpoints.check(
      driver.line(), {"--panel", "--flow", "--pieces", "--per-period", "--mass", "--tension",
                      "--density", "--height", "--substeps", "--relaxation", "--no-aitken"});
  problem.adapts = !one_factor;
  if (every.is_given() && !driver.is_given("--balance"))
    tess::fail(tess::ErrorCode::bad_argument, "--balance-every ", settings.balance_every,
               " is for a balancer, and there is none; give --balance, too");
  if (driver.is_given("--balance")) {
    settings.balance = tess::parse_balance(balance);
    if (settings.balance->when == tess::BalanceWhen::periodic)
      tess::fail(tess::ErrorCode::bad_argument, "--balance ", balance,
                 ": rounds run between steps; leave out when=periodic, and give --balance-every");
  }
  return tess::run(setup, [&] {
    return driver.mode() == Mode::stability ? check_stability(problem.n_pieces, driver)
                                            : run_all(settings, driver);
  });
}

}  // namespace
}  // namespace fsi

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return fsi::start(setup, argc, argv); });
}
