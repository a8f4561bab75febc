// m2m_transfer SOURCE TARGET: moves fields between two tetrahedral meshes and says how far the
// result is from the truth and what each phase cost.
#include "apps/command_line.hpp"
#include "apps/m2m_transfer/driver.hpp"
#include "runtime/runtime.hpp"

namespace {

int run(tess::Setup& setup, int argc, char** argv) {
  tess::m2m::DriverOptions options;
  tess::m2m::Request& request = options.request;
  apps::CommandLine line(
      "Moves fields between two tetrahedral meshes, and prints the error beside the time.",
      "m2m_transfer");
  line.option("SOURCE", request.source, "mesh: ExodusII, gmsh 2.2 or 4.1, or kuhn:N");
  line.option("TARGET", request.target, "mesh: the same kinds");
  line.option("--field", request.fields,
              "gaussian, linear, sin, or an expression in x, y, z; repeat for several");
  line.option("--chares", request.n_chares, "chares of each mesh (default: --per-pe times PEs)")
      .between(1, 1 << 20);
  line.option("--per-pe", request.per_pe, "chares of each mesh on each PE").between(1, 1 << 20);
  line.option("--policy", options.policies, "what vertices outside get: keep, value:V, nearest");
  line.option("--partition", request.partition, "rcb or hsfc");
  line.option("--voxel", request.voxel, "edge of a voxel (default: chosen from the source)")
      .positive();
  line.option("--repeat", options.repeat,
              "transfers in a row; the times are those of the fastest (default: 1, with --study 3)")
      .between(1, 1000000);
  line.option("--out", options.out, "write the target mesh with fields and status as ExodusII");
  line.option("--picture", options.picture,
              "draw a cut through the target, the first field and its error, as SVG");
  line.option("--json", options.json, "write the report as JSON");
  line.flag("--explain", options.explain, "say what this transfer uses and what it left out");
  std::string study;
  const apps::Option studies =
      line.option("--study", study,
                  "error against run time over several transfers, into this folder (default: "
                  "study): SOURCE and TARGET may be ladders, kuhn:8,16,32@0.2 or a.msh,b.msh; "
                  "--policy may be repeated. Instead of a folder, a ladder without TARGET")
          .takes(0, 1);
  if (!line.parse(argc, argv)) return 0;
  if (studies.is_given()) {
    const bool ladder = study.starts_with("kuhn:") && request.source.empty();
    if (ladder) request.source = study;
    options.study = ladder || study.empty() ? "study" : study;
  }
  if (request.source.empty())
    tess::fail(tess::ErrorCode::bad_argument, "SOURCE is missing (--help lists the arguments)");
  return tess::m2m::drive(setup, options);
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) { return run(setup, argc, argv); });
}
