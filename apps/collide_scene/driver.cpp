#include "apps/collide_scene/driver.hpp"

#include "apps/collide_scene/input/load.hpp"
#include "apps/collide_scene/input/motion.hpp"
#include "apps/collide_scene/output/files.hpp"
#include "apps/collide_scene/output/report.hpp"
#include "apps/collide_scene/run/parallel.hpp"
#include "apps/collide_scene/run/serial.hpp"
#include "apps/collide_scene/study/study.hpp"
#include "apps/kit/progress.hpp"
#include "apps/kit/write_file.hpp"

#include <algorithm>

namespace collide_scene {
namespace {

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

void show(kit::Progress& progress, const char* phase, int part, int n_parts) {
  progress.part(part, n_parts);
  progress.phase(phase);
}

/// What is done after the last step; the table is printed first.
int finish(Problem& problem, kit::Progress& progress) {
  const Options& options = problem.report.options;
  RunResult& result = problem.report.result;
  std::ranges::sort(result.pairs);
  show(progress, "measuring the error", 0, 0);
  problem.report.false_positive_rate = false_positive_rate(problem);
  progress.clear();
  tess::print(table(problem.report));
  if (!options.json.empty()) kit::write_file(options.json, json(problem.report));
  if (!options.out.empty()) {
    show(progress, "writing the files of --out", 0, 0);
    write_files(options.out, problem.scene, result.pairs);
  }
  if (!options.study) return 0;
  const std::vector<StudyRow> rows = study(problem.scene, options, progress);
  progress.clear();
  tess::print(study_table(rows));
  if (!options.out.empty()) write_study(options.out, rows);
  return agrees(rows) ? 0 : 1;
}

int run_serial(Problem& problem, kit::Progress& progress) {
  const Options& options = problem.report.options;
  RunResult& result = problem.report.result;
  for (int step = 0; step < options.steps; ++step) {
    show(progress, "colliding", step + 1, options.steps);
    if (step > 0) problem.motion.place(step, problem.scene);
    StepResult& row = result.steps.emplace_back();
    const bool keeps = step + 1 == options.steps && !options.out.empty();
    for (int run = 0; run < options.repeat; ++run) {
      result.pairs.clear();
      const SerialCollision now =
          collide_once(problem.scene, options.rules, step, keeps ? &result.pairs : nullptr);
      row.seconds = run == 0 ? now.seconds : std::min(row.seconds, now.seconds);
      row.answer = now.answer;
      result.grid = now.grid;
    }
  }
  result.peak_memory_bytes = peak_memory_bytes();
  return finish(problem, progress);
}

tess::Task run_parallel(Problem& problem, kit::Progress& progress) {
  const Options& options = problem.report.options;
  RunResult& result = problem.report.result;
  ParallelCollisions collisions(problem.scene, options.rules);
  co_await collisions.begin();
  for (int step = 0; step < options.steps; ++step) {
    show(progress, "colliding", step + 1, options.steps);
    if (step > 0) problem.motion.place(step, problem.scene);
    StepResult& row = result.steps.emplace_back();
    const bool keeps = step + 1 == options.steps && !options.out.empty();
    co_await collisions.step(step, options.repeat, row, keeps ? &result.pairs : nullptr);
  }
  co_await collisions.end(result);
  if (const int code = finish(problem, progress); code != 0) tess::exit(code);
}

}  // namespace

int drive(tess::Setup& setup, const Options& options, bool on_chares) {
  const tess::Machine& machine = *setup.machine;
  const bool speaks = machine.process().value == 0;
  // Every process reads the input: all of them end if it is bad.
  Scene scene = load(options.inputs, options.seed);
  if (options.rules.triangles && scene.triangles.empty())
    tess::fail(tess::ErrorCode::bad_argument, "--triangles: ", options.inputs.front(),
               " has boxes; leave it out, or give a scene of triangles");
  const Motion motion(options.move, scene);
  prepare_files(options);
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
  if (options.explain && speaks) tess::print(explanation(report));
  if (!speaks) scene = {};
  Problem problem{std::move(scene), motion, std::move(report)};
  kit::Progress progress(speaks ? stderr : nullptr);
  if (!on_chares) return run_serial(problem, progress);
  return tess::run(setup, [&]() -> tess::Task { return run_parallel(problem, progress); });
}

}  // namespace collide_scene
