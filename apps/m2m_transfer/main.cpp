// m2m_transfer SOURCE TARGET: moves fields between two tetrahedral meshes and says how far the
// result is from the truth and what each phase cost.
#include "apps/command_line.hpp"
#include "apps/m2m_transfer/driver.hpp"
#include "runtime/runtime.hpp"

namespace {

int run(int argc, char** argv) {
  tess::Setup setup = tess::take_options(argc, argv);
  tess::m2m::DriverOptions options;
  CLI::App app("Moves fields between two tetrahedral meshes, and prints the error beside the time.",
               "m2m_transfer");
  app.add_option("SOURCE", options.source, "mesh: ExodusII, gmsh 2.2 or 4.1, or kuhn:N")
      ->required();
  app.add_option("TARGET", options.target, "mesh: the same kinds")->required();
  app.add_option("--field",
                 options.fields,
                 "gaussian, linear, sin, or an expression in x, y, z; repeat for several");
  app.add_option("--chares", options.n_chares, "chares of each mesh (default: --per-pe times PEs)")
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--per-pe", options.per_pe, "chares of each mesh on each PE")
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--policy", options.policy, "what vertices outside get: keep, value:V, nearest");
  app.add_option("--partition", options.partition, "rcb or hsfc");
  app.add_option("--voxel", options.voxel, "edge of a voxel (default: chosen from the source)")
      ->check(CLI::PositiveNumber);
  app.add_option(
         "--repeat", options.repeat, "transfers in a row; the times are the fastest of each phase")
      ->check(CLI::Range(1, 1000000));
  app.add_option("--out", options.out, "write the target mesh with fields and status as ExodusII");
  app.add_option("--json", options.json, "write the report as JSON");
  app.add_flag("--explain", options.explain, "say what this transfer uses and what it left out");
  if (!apps::parse(app, argc, argv)) return 0;
  return tess::m2m::drive(setup, options);
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return run(argc, argv); });
}
