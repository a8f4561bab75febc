// particles SCENE.json: moves particles among objects by distance/normal fields, and reports
// energies, particles that tunnelled, and the time per particle and step.
#include "apps/kit/write_file.hpp"
#include "apps/particles/options.hpp"
#include "apps/particles/output/files.hpp"
#include "apps/particles/output/report.hpp"
#include "apps/particles/stability/cases.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <fmt/ranges.h>

namespace particles {
namespace {

/// Used on process 0 only.
struct Problem {
  const Options& options;
  Scene scene;
  Report report;
};

tess::Task simulated(Problem& problem, kit::Progress& progress) {
  const auto stage = std::make_shared<Stage>(std::move(problem.scene));
  RunResult result;
  const Options& options = problem.options;
  RunOptions run_options = options.run;
  run_options.progress = &progress;
  co_await simulate(stage, result, run_options);
  progress.clear();
  tess::print(table(stage->scene, result, problem.report));
  const auto write_json = [&] {
    if (!options.json.empty())
      kit::write_file(options.json, json(stage->scene, result, problem.report));
  };
  // The results are written first: a failure of the files and of the study must not lose them.
  write_json();
  if (!options.out.empty()) write_files(options.out, *stage, result);
  if (options.study) {
    StudyOptions study_options;
    study_options.progress = &progress;
    if (!options.resolutions.empty()) study_options.resolutions = options.resolutions;
    problem.report.study = study(stage->scene, study_options);
    progress.clear();
    tess::print(study_table(problem.report.study));
    if (!options.out.empty()) write_study(options.out, problem.report.study);
    write_json();
  }
}

/// Bad input is reported before the run starts.
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
  if (options.study)
    for (const SceneObject& object : problem.scene.objects) require_normals(object);
  check_memory(problem.scene, machine.n_processes());
  prepare_files(problem.scene, options, setup.options.trace);
  if (options.explain && machine.process().value == 0)
    tess::print(explanation(problem.scene, options));
  kit::Progress progress(machine.process().value == 0 ? stderr : nullptr);
  return tess::run(setup, [&]() -> tess::Task { return simulated(problem, progress); });
}

int run(tess::Setup& setup, int argc, char** argv) {
  Options options;
  tess::CommandLine line("Particles against objects of any shape, by distance/normal fields.");
  line.option("SCENE", options.scene, "scene file (JSON); --help-scene lists its keys");
  line.option("--steps", options.steps, "steps instead of the scene's").between(0, 1'000'000'000);
  line.option("--json FILE", options.json, "write the result as JSON");
  line.option("--out DIR", options.out,
              "folder for trajectories, pictures, files of fields and the study");
  line.flag("--explain", options.explain, "print what this scene uses and what it leaves out");
  line.flag("--study", options.study,
            "error against run time of every choice, on the first object");
  line.option("--resolutions N,N,…", options.resolutions,
              "voxels per axis of the study's fields, 4 ... 1024: as 16,32,64,128,256 (default: "
              "16,32,64)")
      .separated_by(',')
      .between(4, 1024);
  line.flag("--compressed", options.compressed,
            "use compressed fields (as the scene's key compression)");
  std::string balance;
  line.option("--balance STRATEGY", balance,
              "migrate blocks: STRATEGY[,when=at_sync|automatic|periodic][,period=50ms][,report]; "
              "strategies: " +
                  fmt::format("{}", fmt::join(tess::balance::strategy_names(), ", ")));
  bool stability = false;
  line.flag("--stability", stability,
            "stiff and extreme cases of every rule; exit code 1 if one fails. Needs no SCENE");
  bool help_scene = false;
  line.flag("--help-scene", help_scene, "describe the keys of a scene file");
  if (!line.parse(argc, argv)) return 0;
  if (help_scene) {
    tess::print(scene_help());
    return 0;
  }
  if (line.is_given("--balance")) options.run.balance = tess::parse_balance(balance);
  if (stability && options.scene.empty())
    line.refuse_without("a SCENE", {"--steps", "--json", "--out", "--explain", "--study",
                                    "--resolutions", "--compressed", "--balance"});
  if (stability) {
    const auto rows = tess::dn::stability_report();
    if (setup.machine->process().value == 0) tess::print(tess::dn::text_of(rows));
    if (!std::ranges::all_of(rows, &tess::dn::StabilityRow::ok)) return 1;
  }
  if (options.scene.empty()) {
    if (stability) return 0;
    tess::fail(tess::ErrorCode::bad_argument, "SCENE is missing; give a scene file (--help)");
  }
  return drive(setup, options);
}

}  // namespace
}  // namespace particles

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return particles::run(setup, argc, argv); });
}
