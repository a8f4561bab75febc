// particles SCENE.json: moves particles among objects by distance/normal fields, and reports
// energies, particles that tunnelled, and the time per particle and step.
#include "apps/command_line.hpp"
#include "apps/particles/driver.hpp"
#include "apps/particles/scene/scene.hpp"
#include "apps/particles/stability/report.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/runtime.hpp"

#include <fmt/format.h>

namespace {

int run(tess::Setup& setup, int argc, char** argv) {
  particles::Options options;
  apps::CommandLine line("Particles against objects of any shape, by distance/normal fields.",
                         "particles");
  line.option("SCENE", options.scene, "scene file (JSON); --help-scene lists its keys");
  line.option("--steps", options.steps, "steps instead of the scene's").between(0, 1'000'000'000);
  line.option("--json", options.json, "write the result as JSON");
  line.option("--out", options.out,
              "folder for trajectories, pictures, files of fields and the study");
  line.flag("--explain", options.explain, "print what this scene uses and what it leaves out");
  line.flag("--study", options.study,
            "error against run time of every choice, on the first object");
  line.option("--resolutions", options.resolutions,
              "voxels per axis of the study's fields, 4 ... 1024: as 16,32,64,128,256 (default: "
              "16,32,64)")
      .separated_by(',')
      .between(4, 1024);
  line.flag("--compressed", options.compressed,
            "use compressed fields (as the scene's key compression)");
  std::string balance;
  line.option("--balance", balance,
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
    tess::print(particles::scene_help());
    return 0;
  }
  if (!balance.empty()) options.run.balance = tess::parse_balance(balance);
  const bool prints = setup.machine->process().value == 0;
  if (stability && !particles::print_stability(prints)) return 1;
  if (options.scene.empty()) {
    if (stability) return 0;
    tess::fail(tess::ErrorCode::bad_argument, "SCENE is missing; give a scene file (--help)");
  }
  return particles::drive(setup, options);
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) { return run(setup, argc, argv); });
}
