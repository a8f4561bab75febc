// m2m_transfer SOURCE TARGET: moves fields between two tetrahedral meshes, and prints the error of
// the result and the time of each phase.
#include "apps/command_line.hpp"
#include "apps/m2m_transfer/driver.hpp"
#include "runtime/runtime.hpp"

namespace {

int run(tess::Setup& setup, int argc, char** argv) {
  m2m_transfer::DriverOptions options;
  m2m_transfer::Request& request = options.request;
  apps::CommandLine line(
      "Moves fields between two tetrahedral meshes, and prints the error and the time.",
      "m2m_transfer");
  line.option(
      "SOURCE", request.source,
      "mesh: an ExodusII or gmsh (2.2, 4.1) file, or kuhn:N, a generated box of 6 N^3 tetrahedra");
  line.option("TARGET", request.target, "mesh of the same kinds");
  line.option(
      "--field,--fields", request.fields,
      "gaussian, linear, sin, an expression in x, y, z, or a field of the source file; repeat "
      "for several");
  line.option("--chares", request.n_chares,
              "chares per mesh (default: --per-pe times the number of PEs)")
      .between(1, 1 << 20);
  line.option("--per-pe", request.per_pe, "chares per mesh and PE").between(1, 1 << 20);
  line.option("--policy", options.policies,
              "value of vertices outside the source: keep, value:V or nearest");
  line.option("--kind", request.kind,
              "linear, second-order (recovered gradients) or limited (the same, bounded by the "
              "vertices around)");
  line.option("--partition", request.partition,
              "method that cuts the meshes into chares: curve (by all PEs together), rcb or hsfc");
  line.option("--voxel", request.voxel, "edge of a voxel (default: chosen from the meshes)")
      .positive();
  line.option(
          "--repeat", options.repeat,
          "number of transfers; the times are those of the fastest (default: 1, with --study 3)")
      .between(1, 1000000);
  line.option("--steps", request.steps,
              "applications of each transfer's donors; the time of the fastest counts")
      .between(1, 1000000);
  line.option("--out", options.out,
              "write the target mesh with the fields and the status to this ExodusII file");
  line.option("--step", options.step,
              "step of the fields that the source file has: a number from 0 on, or all (default: "
              "the last); --out then holds all steps");
  line.option("--weights", options.weights,
              "write the weights of the transfer to this file (NetCDF, ESMF's layout)");
  line.option("--from-weights", options.from_weights,
              "transfer with the weights of this file, without a search");
  line.option("--picture", options.picture,
              "draw the first field and its error in a cut through the target, as SVG");
  line.option("--json", options.json, "write the report to this JSON file");
  line.flag("--explain", options.explain, "print what this transfer uses and what it leaves out");
  std::string study;
  const apps::Option studies =
      line.option(
              "--study", study,
              "measure error against run time over several transfers, and write the files to this "
              "folder (default: study); SOURCE and TARGET can be ladders of meshes such as "
              "kuhn:8,16,32@0.2 or a.msh,b.msh; --policy can be repeated. A ladder without "
              "TARGET can stand in place of the folder")
          .takes(0, 1);
  if (!line.parse(argc, argv)) return 0;
  if (studies.is_given()) {
    const bool ladder = study.starts_with("kuhn:") && request.source.empty();
    if (ladder) request.source = study;
    options.study = ladder || study.empty() ? "study" : study;
  }
  if (request.source.empty())
    tess::fail(tess::ErrorCode::bad_argument,
               "SOURCE is missing; give a source and a target mesh (--help lists the arguments)");
  return m2m_transfer::drive(setup, options);
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) { return run(setup, argc, argv); });
}
