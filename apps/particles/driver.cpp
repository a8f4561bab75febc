#include "apps/particles/driver.hpp"

#include "apps/particles/output/files.hpp"
#include "apps/particles/output/report.hpp"
#include "apps/plot/write_file.hpp"

#include <fmt/ranges.h>

namespace particles {
namespace {

/// Used on process 0 only.
struct Problem {
  const Options& options;
  Scene scene;
  Report report;
};

tess::Task run(Problem& problem, apps::Progress& progress) {
  const auto stage = std::make_shared<Stage>(std::move(problem.scene));
  RunResult result;
  const Options& options = problem.options;
  RunOptions run_options = options.run;
  run_options.progress = &progress;
  co_await simulate(stage, result, run_options);
  progress.clear();
  tess::print(table(stage->scene, result, problem.report));
  // The results are written first: a failure of an extra below must not lose them.
  if (!options.out.empty()) write_files(options.out, *stage, result);
  const auto write_json = [&] {
    if (!options.json.empty())
      plot::write_file(options.json, json(stage->scene, result, problem.report));
  };
  write_json();
  if (options.study) {
    StudyOptions study_options;
    study_options.progress = &progress;
    if (!options.resolutions.empty()) study_options.resolutions = options.resolutions;
    problem.report.study = study(stage->scene, study_options);
    progress.clear();
    tess::print(study_table(problem.report.study));
    if (!options.out.empty()) write_study(options.out, problem.report.study);
  }
  write_json();
}

}  // namespace

int drive(tess::Setup& setup, const Options& options) {
  if (!options.resolutions.empty() && !options.study)
    tess::fail(tess::ErrorCode::bad_argument, "--resolutions ",
               fmt::format("{}", fmt::join(options.resolutions, ",")),
               ": is for a study; add --study, or leave it out (a scene has "
               "objects[i].resolution)");
  Problem problem{options, read_scene(options.scene), {}};
  if (options.steps >= 0) {
    problem.scene.steps = options.steps;
    check_scene(problem.scene);
  }
  if (options.out.empty()) {
    problem.scene.outputs.trajectories = 0;
    problem.scene.outputs.slice.reset();
    problem.scene.outputs.fields = false;
  }
  if (options.compressed) compress_fields(problem.scene);
  const tess::Machine& machine = *setup.machine;
  problem.report = {machine.describe(), machine.n_pes(), machine.n_processes(), options.run};
  if (options.study && problem.scene.objects.empty())
    tess::fail(tess::ErrorCode::bad_value, options.scene,
               ": objects: is empty; --study needs an object to bounce off");
  check_memory(problem.scene, machine.n_processes());
  prepare_files(problem.scene, options);
  if (options.explain && machine.process().value == 0)
    tess::print(explanation(problem.scene, options));
  apps::Progress progress(machine.process().value == 0 ? stderr : nullptr);
  return tess::run(setup, [&]() -> tess::Task { return run(problem, progress); });
}

}  // namespace particles
