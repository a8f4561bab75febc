// particles SCENE.json: moves particles among objects by distance/normal fields, and reports
// energies, particles that tunnelled, and the time per particle and step.
#include "apps/kit/driver.hpp"
#include "apps/particles/output/files.hpp"
#include "apps/particles/output/report.hpp"
#include "apps/particles/stability/cases.hpp"
#include "apps/particles/study/study.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/runtime.hpp"

#include <fmt/ranges.h>

namespace particles {
namespace {

tess::Task simulated(Scene& scene, const Options& options, kit::Driver& driver) {
  const auto stage = std::make_shared<Stage>(std::move(scene));
  RunResult result;
  RunOptions run_options = options.run;
  run_options.progress = &driver.progress();
  co_await simulate(stage, result, run_options);
  driver.progress().clear();
  const kit::Json found = report(stage->scene, result, run_options);
  tess::print_text(tess::machine().describe() + "\n" + table(found, result));
  // The results are written first: a failure of the other files must not lose them.
  driver.write(std::array{found});
  if (!options.out.empty()) write_files(options.out, *stage, result);
}

tess::Task studied(const Scene& scene, const Options& options, kit::Driver& driver) {
  StudyOptions study_options;
  study_options.progress = &driver.progress();
  if (!options.resolutions.empty()) study_options.resolutions = options.resolutions;
  const std::vector<StudyRow> rows = study(scene, study_options);
  driver.progress().clear();
  tess::print_text(tess::machine().describe() + "\n" + study_table(rows));
  driver.write(study_report().json(rows));
  if (!options.out.empty()) draw_study(options.out, rows);
  co_return;
}

tess::Task check_stability(kit::Driver& driver) {
  const std::vector<kit::Case> found = tess::dn::stability_report();
  driver.progress().clear();
  kit::Cases<> cases;
  for (const kit::Case& one : found) cases.add(one);
  if (const int code = cases.finish(driver); code != 0) tess::exit(code);
  co_return;
}

/// The scene of a run or a study. Bad input is reported before either starts.
Scene prepared(const tess::Machine& machine, const Options& options, kit::Driver& driver) {
  if (options.scene.empty())
    tess::fail(tess::ErrorCode::bad_argument, "SCENE is missing; give a scene file (--help)");
  Scene scene = read_scene(options.scene);
  if (options.steps) {
    scene.steps = *options.steps;
    check_scene(scene);
  }
  if (options.out.empty()) {
    scene.outputs.trajectories = 0;
    scene.outputs.slice.reset();
    scene.outputs.fields = false;
  }
  if (options.compressed) compress_fields(scene);
  if (options.study) {
    if (scene.objects.empty())
      tess::fail(tess::ErrorCode::bad_value, options.scene,
                 ": objects: is empty; --study needs an object to bounce off");
    for (const SceneObject& object : scene.objects) require_normals(object);
  } else {
    check_memory(scene, machine.n_processes());
  }
  prepare_files(scene, options, driver.files());
  if (driver.explains() && driver.speaks()) tess::print(explanation(scene, options.run));
  return scene;
}

int run(tess::Setup& setup, int argc, char** argv) {
  Options options;
  using kit::Mode;
  kit::Driver driver(setup, "Particles against objects of any shape, by distance/normal fields.");
  driver.in(Mode::run | Mode::study);
  driver.option("SCENE", options.scene, "scene file (JSON); --help-scene lists its keys");
  driver.folder("--out DIR", options.out,
                "folder for trajectories, pictures and files of fields, or pictures of the study");
  driver.json();
  driver.in(Mode::run);
  driver.option("--steps", options.steps, "steps instead of the scene's").between(0, 1'000'000'000);
  driver.explain("print what this scene uses and what it leaves out");
  driver.flag("--compressed", options.compressed,
              "use compressed fields (as the scene's key compression)");
  std::string balance;
  driver.option(
      "--balance STRATEGY", balance,
      "migrate blocks: STRATEGY[,when=at_sync|automatic|periodic][,period=50ms][,report]; "
      "strategies: " +
          fmt::format("{}", fmt::join(tess::balance::strategy_names(), ", ")));
  bool help_scene = false;
  driver.flag("--help-scene", help_scene, "describe the keys of a scene file");
  driver.in(Mode::study);
  driver.study("error against run time of every choice, on the first object");
  driver
      .option("--resolutions N,N,…", options.resolutions,
              "voxels per axis of the study's fields, 4 ... 1024: as 16,32,64,128,256 (default: "
              "16,32,64)")
      .separated_by(',')
      .between(4, 1024);
  driver.stability("stiff and extreme cases of every rule; without a SCENE");
  driver.examples({"--help-scene", "bouncy.json --steps 20 --pes 2 --out bouncy",
                   "bouncy.json --study --resolutions 8,16"});
  if (!driver.parse(argc, argv)) return 0;
  if (help_scene) {
    tess::print(scene_help());
    return 0;
  }
  if (driver.mode() == Mode::stability)
    return tess::run(setup, [&] { return check_stability(driver); });
  options.study = driver.mode() == Mode::study;
  if (driver.is_given("--balance")) options.run.balance = tess::parse_balance(balance);
  Scene scene = prepared(*setup.machine, options, driver);
  return tess::run(setup, [&] {
    return options.study ? studied(scene, options, driver) : simulated(scene, options, driver);
  });
}

}  // namespace
}  // namespace particles

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return particles::run(setup, argc, argv); });
}
