// collide_scene INPUT…: finds the objects of a scene that collide, and reports pairs, candidates,
// false positives and the time per object.
#include "apps/collide_scene/input/load.hpp"
#include "apps/collide_scene/input/motion.hpp"
#include "apps/collide_scene/output/files.hpp"
#include "apps/collide_scene/output/report.hpp"
#include "apps/collide_scene/run/parallel.hpp"
#include "apps/collide_scene/run/serial.hpp"
#include "apps/collide_scene/stability/cases.hpp"
#include "apps/collide_scene/study/pes.hpp"
#include "apps/collide_scene/study/voxels.hpp"
#include "apps/kit/driver.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace collide_scene {
namespace {

using kit::Mode;
constexpr kit::Modes voxels = Mode::study, pes = Mode::own(0);

/// Used on process 0 only.
struct Problem {
  Scene scene;  // where its objects are at the step of the run
  Motion motion;
  Report report;
};

/// The part of the pairs of boxes that are no pairs of objects, in the last step.
std::optional<double> false_positive_rate(const Problem& problem) {
  constexpr std::uint64_t most_candidates = 20'000'000;
  const Options& options = problem.report.options;
  if (problem.scene.triangles.empty()) return 0;
  Answer last = problem.report.result.steps.back().answer;
  if (!options.rules.triangles) {
    if (last.n_candidates > most_candidates) return std::nullopt;
    Rules exact = options.rules;
    exact.triangles = true;
    exact.voxel_size = 0;  // that of the run may be too small for one thread's grid
    last.n_pairs = collide_once(problem.scene, exact, 0).answer.n_pairs;
  }
  if (last.n_candidates == 0) return 0;
  return 1 - static_cast<double>(last.n_pairs) / static_cast<double>(last.n_candidates);
}

/// Moves the scene to a step; returns the place of its result.
StepResult& begin_step(Problem& problem, int step, kit::Progress& progress) {
  progress.part(step + 1, problem.report.options.steps);
  progress.phase("colliding");
  if (step > 0) problem.motion.place(step, problem.scene);
  return problem.report.result.steps.emplace_back();
}

/// What is done after the last step; the table is printed first.
void finish(Problem& problem, kit::Driver& driver) {
  kit::Progress& progress = driver.progress();
  RunResult& result = problem.report.result;
  std::ranges::sort(result.pairs);
  progress.part(0, 0);
  progress.phase("measuring the error");
  problem.report.false_positive_rate = false_positive_rate(problem);
  progress.clear();
  tess::print(table(problem.report));
  driver.write(std::array{json(problem.report)});
  const std::string& prefix = problem.report.options.out;
  progress.phase("writing the files of --out");
  if (!prefix.empty()) write_files(prefix, problem.scene, result, problem.report.n_pes);
}

/// The pairs of the last step are kept for --out.
std::vector<ScenePair>* place_of_pairs(Problem& problem, int step) {
  const Options& options = problem.report.options;
  const bool keeps = step + 1 == options.steps && !options.out.empty();
  return keeps ? &problem.report.result.pairs : nullptr;
}

int run_serial(Problem& problem, kit::Driver& driver) {
  const Options& options = problem.report.options;
  RunResult& result = problem.report.result;
  for (int step = 0; step < options.steps; ++step) {
    StepResult& row = begin_step(problem, step, driver.progress());
    for (int run = 0; run < options.repeat; ++run) {
      result.pairs.clear();
      const SerialCollision now =
          collide_once(problem.scene, options.rules, step, place_of_pairs(problem, step));
      row.seconds = run == 0 ? now.seconds : std::min(row.seconds, now.seconds);
      row.answer = now.answer;
      result.grid = now.grid;
    }
  }
  result.peak_memory_bytes = peak_memory_bytes();
  finish(problem, driver);
  return 0;
}

tess::Task run_parallel(Problem& problem, kit::Driver& driver) {
  const Options& options = problem.report.options;
  ParallelCollisions collisions(problem.scene, options.rules);
  co_await collisions.begin();
  for (int step = 0; step < options.steps; ++step) {
    StepResult& row = begin_step(problem, step, driver.progress());
    co_await collisions.step(step, options.repeat, row, place_of_pairs(problem, step));
  }
  co_await collisions.end(problem.report.result);
  finish(problem, driver);
}

int run_once(tess::Setup& setup, const Options& options, bool on_chares, kit::Driver& driver) {
  const tess::Machine& machine = *setup.machine;
  // Every process reads the input: all of them end if it is bad.
  Scene scene = load(options.inputs, options.seed);
  if (options.rules.triangles && scene.triangles.empty())
    tess::fail(tess::ErrorCode::bad_argument, "--triangles: ", options.inputs.front(),
               " has boxes; leave it out, or give a scene of triangles");
  const Motion motion(options.move, scene);
  prepare_files(options.out, endings(), driver.files());
  Report report{.options = options,
                .scene = scene.description,
                .n_objects = scene.n_objects(),
                .n_triangles = scene.triangles.size(),
                .n_models = n_models(scene),
                .motion = motion.describe(),
                .machine = machine.describe(),
                .on_chares = on_chares,
                .n_pes = on_chares ? machine.n_pes() : 1,
                .n_processes = machine.n_processes()};
  if (driver.explains() && driver.speaks()) tess::print(explanation(report));
  if (!driver.speaks()) scene = {};
  Problem problem{std::move(scene), motion, std::move(report)};
  if (!on_chares) return run_serial(problem, driver);
  return tess::run(setup, [&]() -> tess::Task { return run_parallel(problem, driver); });
}

/// Returns the exit code.
int end_of_study(bool agrees) {
  if (!agrees) std::fprintf(stderr, "collide_scene: a row of the study has other pairs\n");
  return agrees ? 0 : 1;
}

int run_voxels(const Options& options, kit::Driver& driver) {
  Scene scene = load(options.inputs, options.seed);
  const Motion motion(options.move, scene);
  prepare_files(options.out, voxel_files(), driver.files());
  if (options.steps > 1) motion.place(options.steps - 1, scene);
  const std::vector<VoxelRow> rows = study_voxels(scene, options, driver.progress());
  driver.progress().clear();
  tess::print(scene.description, "\n", voxel_report().table(rows),
              "factor: of the voxel size that the library chooses; false: pairs of boxes that are "
              "no pairs of objects; CPU time per object, the least of three\n");
  driver.write(voxel_report().json(rows));
  if (!options.out.empty()) draw_voxels(options.out, rows);
  return end_of_study(agrees(rows));
}

int run_pes(Options options, kit::Driver& driver) {
  if (!driver.is_given("--steps")) options.steps = 12;
  check_ladder(options);
  prepare_files(options.out, {"_pes.svg", "_pes.csv"}, driver.files());
  tess::print(pes_report().head());
  const std::vector<PesRow> rows = study_pes(
      options, driver.progress(), [](const PesRow& row) { tess::print(pes_report().line(row)); });
  driver.write(pes_report().json(rows));
  if (!options.out.empty())
    (void)kit::write_svg(options.out + "_pes.svg", chart_of(rows, options.ladder.is_weak));
  return end_of_study(std::ranges::all_of(rows, &PesRow::agrees));
}

/// True if the command line asks for PEs of the runtime; it removes these options later.
bool asks_for_pes(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view option(argv[i]);
    const std::string_view name = option.substr(0, option.find('='));
    if (name == "--pes" || name == "--sim") return true;
  }
  return false;
}

int start(tess::Setup& setup, int argc, char** argv, bool on_chares) {
  Options options;
  Ladder& ladder = options.ladder;
  std::string study;
  bool self = false;
  kit::Driver driver(
      setup,
      "Finds the objects of a scene that collide. In one thread; with --pes, --sim or under mpirun "
      "on chares.");
  driver.in(Mode::run | voxels | pes);
  driver.option("INPUT", options.inputs,
                "files of triangles (.obj, .ply, .stl), each a model, or scenes NAME:N (below)");
  driver
      .option("--steps", options.steps, "steps of a scene that moves (default: 1; --study pes: 12)")
      .between(1, 1'000'000'000);
  driver.option(
      "--move HOW", options.move,
      "how models move: own (as the scene does by itself), still, drift[:SIZES per step], "
      "turn[:DEGREES per step]");
  driver.flag("--self", self, "find pairs within a model, too");
  driver.flag("--open", options.rules.open, "objects that only touch are no pair");
  driver.option("--seed", options.seed, "of scenes with random places");
  driver.option("--out PREFIX", options.out,
                "write PREFIX.svg (what collides), PREFIX_owners.svg (owners, voxels), "
                "PREFIX_hits.vtp and PREFIX_pairs.vtp (ParaView), or "
                "the table and charts of a study");
  driver
      .option("--study WHAT", study,
              "voxels: voxel sizes, boxes and exact triangles: time against candidates and false "
              "positives; pes: simulated machines of more and more PEs: speed-up")
      .one_of({"voxels", "pes"});
  driver.enters("--study", voxels, "voxels");
  driver.enters("--study", pes, "pes");
  driver.json();
  driver.in(Mode::run | pes);
  driver
      .option("--voxel-size", options.rules.voxel_size,
              "edge of a voxel (default: chosen from the objects)")
      .positive();
  driver.in(Mode::run);
  driver.flag("--triangles", options.rules.triangles,
              "test pairs of triangles exactly; otherwise their boxes count");
  driver
      .option("--slack LENGTH", options.rules.slack,
              "on chares: keep the pairs of boxes that are larger by this, and test them alone "
              "while each object stays within its larger box")
      .positive();
  driver.repeat(options.repeat, "collisions per step; the fastest counts");
  driver.flag("--serial", options.serial, "one thread, without the runtime (the default)");
  driver.explain();
  driver.in(pes);
  driver.option("--machines N,N,…", ladder.pes, "PEs of the machines of --study pes")
      .separated_by(',')
      .between(1, 1 << 20);
  driver.flag("--weak", ladder.is_weak, "the N of each scene NAME:N is that of one PE");
  driver.option("--balance STRATEGY", ladder.balance, "strategies to compare, or none")
      .separated_by(',');
  driver
      .option("--costs NS,…", ladder.costs,
              "nanoseconds of an item of each part of a search on a simulated machine: gridding, "
              "search, pair, reply, copy, record")
      .separated_by(',')
      .takes(6, 6);
  driver.option("--network KEYS", ladder.network, "what else --sim would say of these machines");
  driver.stability("extreme scenes against brute force");
  driver.footer(scenes_help());
  driver.examples({"planes:4096 --triangles --pes 2", "crowd:4096 --steps 5 --pes 2 --explain",
                   "planes:4096 --study voxels --out planes"});
  if (!driver.parse(argc, argv)) return 0;
  if (self) options.rules.within_model = tess::collide::WithinModel::test;
  driver.refuse_both("--repeat", "--slack");
  if (on_chares && (options.serial || driver.mode() != Mode::run))
    tess::fail(tess::ErrorCode::bad_argument,
               options.serial                     ? "--serial"
               : driver.mode() == Mode::stability ? "--stability"
                                                  : "--study " + study,
               ": needs no PEs of this run; leave it out, or --pes, --sim and mpirun");
  if (options.rules.slack > 0 && !on_chares)
    tess::fail(tess::ErrorCode::bad_argument, "--slack: is for chares; add --pes, or leave it out");
  if (driver.mode() == Mode::stability) return report_stability(driver);
  if (options.inputs.empty())
    tess::fail(tess::ErrorCode::bad_argument,
               "INPUT is missing; give files or a scene such as planes:65536 (--help)");
  for (const std::string& input : options.inputs) driver.files().reads("INPUT", input);
  if (driver.mode() == voxels) return run_voxels(options, driver);
  if (driver.mode() == pes) return run_pes(options, driver);
  return run_once(setup, options, on_chares, driver);
}

}  // namespace
}  // namespace collide_scene

int main(int argc, char** argv) {
  const bool asks = collide_scene::asks_for_pes(argc, argv);
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    return collide_scene::start(setup, argc, argv, asks || setup.machine->n_processes() > 1);
  });
}
