// leanmd: molecular dynamics on cells and pairs of cells, after the Charm++ miniapp of this name.
#include "apps/kit/driver.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "apps/leanmd/report.hpp"
#include "apps/leanmd/stability.hpp"
#include "apps/leanmd/study.hpp"

#include <cmath>
#include <fmt/ranges.h>

namespace leanmd {
namespace {

struct Settings {
  Options options;
  InitialState state{.n_atoms = 4000, .gradient = 0.8};
  double density = 0.5;
  std::vector<std::int32_t> cells{6, 6, 6};
  std::string balance;
};

tess::Task run_once(Settings s, kit::Driver& driver) {
  if (driver.explains()) tess::print(explain(s.options, s.state.n_atoms));
  std::vector<Atom> atoms;
  if (!s.options.checkpoints.restarts())
    atoms = initial_atoms(s.state, Motion(s.options.problem.box.edge, s.options.problem.dt));
  Outcome outcome;
  co_await simulate(s.options, std::move(atoms), outcome);
  driver.progress().clear();
  tess::print(table(s.options, outcome));
  if (outcome.error.empty()) {
    kit::Json results = kit::Json::array();
    results.push_back(json_of(s.options, outcome));
    driver.write(results);
  } else {
    kit::end_with("leanmd: " + outcome.error);
  }
}

tess::Task run_study(Settings s, kit::Driver& driver) {
  std::vector<StudyRow> rows;
  co_await study(s.options, s.state, rows);
  driver.progress().clear();
  const std::optional<double> order = fitted_order(rows);
  tess::print(study_rows().table(rows),
              fmt::format("fitted order {}; drift: greatest change of the total energy per atom\n",
                          order ? fmt::format("{:.2f}", *order) : "-"));
  driver.write(study_rows().json(rows), {{"fitted_order", order}});
  driver.draw(study_chart(rows));
  for (const StudyRow& row : rows)
    if (row.is_wrong) {
      kit::end_with(fmt::format("leanmd: --dt {}: {}", row.dt, row.error));
      co_return;
    }
}

tess::Task run_stability(kit::Driver& driver) {
  kit::Cases<> report;
  co_await stability_report(report);
  const int code = report.finish(
      driver,
      "met: energy drift per atom; each case that runs agrees with all pairs and returns "
      "to its start\n");
  if (code != 0) tess::exit(code);
}

template <class... Text>
[[noreturn]] void refuse(const Text&... text) {
  tess::fail(tess::ErrorCode::bad_argument, text...);
}

/// What no single option of the problem can be checked for.
void check_problem(Settings& s) {
  Problem& p = s.options.problem;
  if (!(s.density > 0 && s.density <= 1))
    refuse("--density: ", s.density, " is not above 0 and at most 1");
  if (!(s.state.gradient >= 0 && s.state.gradient <= 1))
    refuse("--gradient: ", s.state.gradient, " is not from 0 to 1");
  if (!(s.state.temperature >= 0 && s.state.temperature <= 1000))
    refuse("--temperature: ", s.state.temperature, " is not from 0 to 1000");
  if (!(p.dt >= least_dt && p.dt <= 1)) refuse("--dt: ", p.dt, " is not from 1e-5 to 1");
  if (!(p.skin >= 0)) refuse("--skin: ", p.skin, " is negative");
  if (!(p.cutoff >= 1)) refuse("--cutoff: ", p.cutoff, " is not at least 1");
  s.state.edge = std::cbrt(static_cast<double>(s.state.n_atoms) / s.density);
  p.box.edge = s.state.edge;
  if (2 * (p.cutoff + p.skin) > p.box.edge)
    refuse("--cutoff: ", p.cutoff, " and --skin ", p.skin,
           " reach over half of the box, whose edge is ", p.box.edge,
           "; give more --atoms or a lower --density");
  for (const std::int32_t n : s.cells)
    if (n < 1 || n > 256) refuse("--cells: ", n, " is not from 1 to 256");
  std::ranges::copy(s.cells, p.box.n_cells.begin());
  if (4 * p.box.least_cell_edge() < p.cutoff + p.skin)
    refuse("--cells: a cell of edge ", p.box.least_cell_edge(),
           " is shorter than a quarter of --cutoff and --skin; give fewer cells");
}

int run(tess::Setup& setup, int argc, char** argv) {
  Settings s;
  Problem& p = s.options.problem;
  using kit::Mode;
  kit::Driver driver(setup, "Molecular dynamics: Lennard-Jones atoms in a periodic box.");
  driver.in(Mode::run | Mode::study);
  driver.option("--cells N,N,N", s.cells, "cells of the box on each axis: as 4,4,4")
      .separated_by(',')
      .takes(3, 3);
  driver.option("--atoms", s.state.n_atoms, "number of atoms").between(1, 1 << 20);
  driver.option("--steps", s.options.n_steps, "time steps").between(0, 100'000'000);
  driver.option("--dt", p.dt, "time step, in reduced units");
  driver.option("--cutoff", p.cutoff, "distance from which on atoms have no force on each other");
  driver.option("--density", s.density, "atoms per volume; the box has the edge that follows");
  driver.option("--gradient", s.state.gradient, "0: even; 1: all the denser the smaller x is");
  driver.option("--temperature", s.state.temperature, "of the start");
  driver.option("--seed", s.state.seed, "of the start");
  driver.option("--exchange", p.exchange_every, "steps after which atoms change cells")
      .between(1, 1'000'000);
  driver.option("--skin", p.skin, "atoms may move by half of it between two exchanges");
  driver.option("--every", p.every, "steps between two looks at the result, and balance barriers")
      .between(1, 1'000'000);
  driver.option(
      "--balance STRATEGY", s.balance,
      "computes migrate: STRATEGY[,when=at_sync|automatic|periodic][,period=50ms][,report]");
  driver.flag("--check", s.options.check, "compare the first and the last forces with all pairs");
  driver.flag("--reverse", s.options.reverse,
              "afterwards run back with reversed velocities: must return to the start");
  driver.json();
  driver.in(Mode::run);
  driver.explain("print what this run does");
  s.options.checkpoints.add_options(driver);
  driver.in(Mode::study);
  driver.study("energy drift against time step: five of them");
  driver.picture("draw the study");
  driver.stability("stiff and extreme cases");
  driver.examples({"--atoms 500 --density 0.4 --cells 2,2,2 --steps 20 --check --pes 2",
                   "--atoms 500 --density 0.4 --cells 2,2,2 --steps 20 --balance greedy_refine "
                   "--sim pes=4,cost=500ns",
                   "--atoms 500 --density 0.4 --cells 2,2,2 --steps 20 --reverse"});
  if (!driver.parse(argc, argv)) return 0;
  driver.refuse_both("--explain", "--restart");  // which takes the checkpoint's options
  s.options.checkpoints.check(driver.line(),
                              {"--cells", "--atoms", "--dt", "--cutoff", "--density", "--gradient",
                               "--temperature", "--seed", "--exchange", "--skin", "--every"});
  if (driver.is_given("--balance")) s.options.balance = tess::parse_balance(s.balance);
  if (!s.options.checkpoints.restarts()) check_problem(s);  // otherwise it is in the checkpoint
  if (driver.mode() == Mode::study &&
      !(p.dt >= 8 * least_dt && p.dt <= 0.5 && s.options.n_steps >= 1))
    refuse("--study: takes steps of an eighth to twice of --dt ", p.dt,
           ", from 1e-5 to 1, and at least one of --steps ", s.options.n_steps);
  s.options.progress = &driver.progress();
  return tess::run(setup, [&]() -> tess::Task {
    if (driver.mode() == Mode::stability) return run_stability(driver);
    return driver.mode() == Mode::study ? run_study(s, driver) : run_once(s, driver);
  });
}

}  // namespace
}  // namespace leanmd

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return leanmd::run(setup, argc, argv); });
}
