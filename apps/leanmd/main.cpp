// leanmd: molecular dynamics on cells and pairs of cells, after the Charm++ miniapp of this name.
#include "apps/kit/file_names.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "apps/leanmd/report.hpp"
#include "apps/leanmd/stability.hpp"
#include "apps/leanmd/study.hpp"
#include "runtime/command_line.hpp"

#include <cmath>
#include <fmt/ranges.h>

namespace leanmd {
namespace {

struct Settings {
  Options options;
  InitialState state{.n_atoms = 4000, .gradient = 0.8};
  double density = 0.5;
  std::vector<std::int32_t> cells{6, 6, 6};
  std::string balance, json, plot;
  bool study = false, stability = false, explain = false;
};

tess::Task run_once(Settings s) {
  if (s.explain) tess::print(explain(s.options, s.state.n_atoms));
  std::vector<Atom> atoms;
  if (!s.options.checkpoints.restarts())
    atoms = initial_atoms(s.state, Motion(s.options.problem.box.edge, s.options.problem.dt));
  Outcome outcome;
  co_await simulate(s.options, std::move(atoms), outcome);
  s.options.progress->clear();
  tess::print(table(s.options, outcome));
  if (!s.json.empty() && outcome.error.empty()) kit::write_file(s.json, json(s.options, outcome));
  if (!outcome.error.empty()) kit::end_with("leanmd: " + outcome.error);
}

tess::Task run_study(Settings s) {
  std::vector<StudyRow> rows;
  co_await study(s.options, s.state, rows);
  s.options.progress->clear();
  tess::print(study_table(rows));
  if (!s.json.empty()) kit::write_file(s.json, study_json(rows));
  if (!s.plot.empty()) draw_study(s.plot, rows);
  for (const StudyRow& row : rows)
    if (row.is_wrong) {
      kit::end_with(fmt::format("leanmd: --dt {}: {}", row.dt, row.error));
      co_return;
    }
}

tess::Task run_stability(Settings s) {
  std::vector<StabilityRow> rows;
  co_await stability_report(rows);
  s.options.progress->clear();
  tess::print(stability_table(rows));
  for (const StabilityRow& row : rows)
    if (!row.ok) kit::end_with("leanmd: " + row.name + " failed");
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

/// Which options work together, and the files.
void check_use(const Settings& s, const std::string& trace) {
  const Problem& p = s.options.problem;
  if (s.study && !(p.dt >= 8 * least_dt && p.dt <= 0.5 && s.options.n_steps >= 1))
    refuse("--study: takes steps of an eighth to twice of --dt ", p.dt,
           ", from 1e-5 to 1, and at least one of --steps ", s.options.n_steps);
  if (s.study && s.stability) tess::refuse_together("--study", "--stability");
  if (s.stability && !s.json.empty()) tess::refuse_together("--json " + s.json, "--stability");
  if (s.explain && (s.study || s.stability))
    tess::refuse_together("--explain", s.study ? "--study" : "--stability");
  if ((s.study || s.stability) && s.options.checkpoints.are_used())
    refuse("--checkpoint and --restart: not for --study and --stability");
  if (s.explain && s.options.checkpoints.restarts())
    refuse("--explain: describes the options, but --restart takes the checkpoint's");
  if (!s.plot.empty() && !s.study) refuse("--plot ", s.plot, ": is for --study");
  kit::require_writable("--json", s.json);
  kit::require_picture("--plot", s.plot);
  kit::FileNames names;
  names.writes("--trace", trace);
  names.writes("--json", s.json);
  names.writes_picture("--plot", s.plot);
}

int run(tess::Setup& setup, int argc, char** argv) {
  Settings s;
  Problem& p = s.options.problem;
  tess::CommandLine line("Molecular dynamics: Lennard-Jones atoms in a periodic box.");
  line.option("--cells N,N,N", s.cells, "cells of the box on each axis: as 4,4,4")
      .separated_by(',')
      .takes(3, 3);
  line.option("--atoms", s.state.n_atoms, "number of atoms").between(1, 1 << 20);
  line.option("--steps", s.options.n_steps, "time steps").between(0, 100'000'000);
  line.option("--dt", p.dt, "time step, in reduced units");
  line.option("--cutoff", p.cutoff, "distance from which on atoms have no force on each other");
  line.option("--density", s.density, "atoms per volume; the box has the edge that follows");
  line.option("--gradient", s.state.gradient, "0: even; 1: all the denser the smaller x is");
  line.option("--temperature", s.state.temperature, "of the start");
  line.option("--seed", s.state.seed, "of the start");
  line.option("--exchange", p.exchange_every, "steps after which atoms change cells")
      .between(1, 1'000'000);
  line.option("--skin", p.skin, "atoms may move by half of it between two exchanges");
  line.option("--every", p.every, "steps between two looks at the result, and balance barriers")
      .between(1, 1'000'000);
  line.option(
      "--balance STRATEGY", s.balance,
      "computes migrate: STRATEGY[,when=at_sync|automatic|periodic][,period=50ms][,report]");
  line.flag("--check", s.options.check, "compare the first and the last forces with all pairs");
  line.flag("--reverse", s.options.reverse,
            "afterwards run back with reversed velocities: must return to the start");
  line.option("--json FILE", s.json, "write the result as JSON");
  line.flag("--study", s.study, "energy drift against time step: five of them");
  line.option("--plot FILE", s.plot, "draw the study: FILE.svg");
  line.flag("--stability", s.stability, "stiff and extreme cases; exit code 1 if one fails");
  line.flag("--explain", s.explain, "print what this run does");
  s.options.checkpoints.add_options(line);
  if (!line.parse(argc, argv)) return 0;
  s.options.checkpoints.check(
      line, {"--cells", "--atoms", "--dt", "--cutoff", "--density", "--gradient", "--temperature",
             "--seed", "--exchange", "--skin", "--every"});
  if (line.is_given("--balance")) s.options.balance = tess::parse_balance(s.balance);
  if (s.stability)  // its cases have their own problems
    line.refuse_beside("--stability",
                       {"--cells", "--atoms", "--steps", "--dt", "--cutoff", "--density",
                        "--gradient", "--temperature", "--seed", "--exchange", "--skin", "--every",
                        "--balance", "--check", "--reverse"});
  if (!s.options.checkpoints.restarts()) check_problem(s);  // else it is in the checkpoint
  check_use(s, setup.options.trace);
  kit::Progress progress(setup.machine->process() == tess::ProcessId{0} ? stderr : nullptr);
  s.options.progress = &progress;
  return tess::run(setup, [&]() -> tess::Task {
    if (s.stability) return run_stability(s);
    return s.study ? run_study(s) : run_once(s);
  });
}

}  // namespace
}  // namespace leanmd

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return leanmd::run(setup, argc, argv); });
}
