#include "apps/m2m_transfer/options.hpp"

#include "m2m/transfer_kind.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"

#include <filesystem>

namespace m2m_transfer {
namespace {

/// "linear, second-order, …"
std::string kind_names() {
  std::string out;
  for (const tess::m2m::TransferKind kind : tess::m2m::all_transfer_kinds)
    out += (out.empty() ? "" : ", ") + std::string(name_of(kind));
  return out;
}

void add_options(tess::CommandLine& line, DriverOptions& options, std::string& study) {
  Request& request = options.request;
  line.option(
      "SOURCE", request.source,
      "mesh: an ExodusII, gmsh (2.0 to 2.2, 4.1) or VTU file, or kuhn:N, a generated box of 6 N^3 "
      "tetrahedra");
  line.option("TARGET", request.target, "mesh of the same kinds");
  line.option("MORE", request.more, "further meshes of the same kinds, for --pairs");

  line.group("Transfer");
  line.option(
      "--field,--fields NAMES", request.fields,
      "gaussian, linear, sin, an expression in x, y, z, or a field of the source file at vertices "
      "or in elements (moved to the target's elements); several as --fields sin,x*y");
  line.option(
      "--kind KIND", request.kind,
      "how values follow from the source: " + kind_names() + "; all: a table with a row per kind");
  line.option("--pairs A:B,B:C", request.pairs,
              "which mesh gives values to which, by letter (A is SOURCE, B is TARGET) or file. "
              "Pairs run in the order given where they share a mesh that is written, otherwise at "
              "once")
      .joined_by(',');
  line.option("--policy POLICY", options.policies,
              "value of vertices outside the source: keep, value:V or nearest");
  line.option("--tolerance LENGTH", request.tolerance,
              "vertices outside the source but nearer than this snap to it");
  line.flag("--clamp", request.clamp, "keep values within those of the donor's vertices");
  line.option("--steps", request.steps,
              "applications of all pairs, with the donors of one search; the time of the fastest "
              "counts")
      .between(1, 1000000);
  line.option("--move MOTION", request.moves,
              "move a mesh before every step but the first, and search again: "
              "'B:rotate(0,0,1,5deg)' about its middle, 'B:rotate(0,0,1,5deg,0,0,0)' about a "
              "point, or 'B:translate(0.1,0,0)'; repeat for several");
  line.option("--step N|all", options.step,
              "step of the fields that the source file has, from 0 on, or all (default: the last); "
              "--out then holds all steps");
  line.option("--from-weights FILE", options.from_weights,
              "transfer with the weights of this file, without a search");

  line.group("Chares");
  line.option("--chares", request.n_chares,
              "chares per mesh (default: --per-pe times the number of PEs)")
      .between(1, 1 << 20);
  line.option("--per-pe", request.per_pe, "chares per mesh and PE").between(1, 1 << 20);
  line.option("--partition METHOD", request.partition,
              "how the meshes are cut into chares: curve (by all PEs together), rcb or hsfc");
  line.option("--voxel LENGTH", request.voxel, "edge of a voxel (default: chosen from the meshes)")
      .positive();

  line.group("Output");
  line.option(
      "--out FILE", options.out,
      "write the target mesh with the fields and the status (transfer_status if a field is called "
      "status): ExodusII if it ends in .exo, .e, "
      ".ex2, .g, .exii, .gen or .ncdf, VTU if in .vtu, VTU written by all processes, a file per "
      "chare, if in .pvtu; with several targets to FILE.B.exo, FILE.C.exo");
  line.option("--weights FILE", options.weights,
              "write the weights of the transfer (NetCDF, ESMF's layout)");
  line.option("--picture FILE", options.picture,
              "draw the first field and its error in a cut through the target, as SVG");
  line.option("--json FILE", options.json, "write the report as JSON");
  line.flag("--explain", options.explain, "print what this transfer uses and what it leaves out");

  line.group("Studies");
  line.option(
          "--repeat", options.repeat,
          "number of transfers; the times are those of the fastest (default: 1, with --study 3)")
      .between(1, 1000000);
  line.option("--study WHAT", study,
              "h: error against run time over several meshes (default); kind: the same for every "
              "kind; steps: the time that kept donors save. SOURCE and TARGET can be ladders such "
              "as kuhn:8,16,32@0.2 or a.msh,b.msh; --policy can be repeated. A folder (as --plot; "
              "./NAME if it is new) or a ladder without TARGET can stand in place of h")
      .takes(0, 1);
  line.option("--round-trips N,N,…", options.round_trips,
              "SOURCE to TARGET and back with one pair of handles, and the drift after so many "
              "trips; for all kinds, or the --kind given");
  line.option("--plot DIR", options.plot,
              "write the table of --study or --round-trips as CSV, JSON and SVG to this folder");
  line.flag("--stability", options.stability,
            "extreme meshes and points, and the same of SOURCE and TARGET where they are given: "
            "points lost, error, bits; exit code 1 if a row fails; --policy and --partition "
            "(default: rcb) hold for every case");
}

/// What follows `--study`: the name of a study, a ladder of meshes or the folder of `--plot`.
void read_study(const std::string& study, DriverOptions& options) {
  const bool is_named = study == "h" || study == "kind" || study == "steps";
  const bool is_ladder = study.starts_with("kuhn:") && options.request.source.empty();
  // A folder has a '/' unless it is there already: a word may be the name of a study, mistyped.
  if (!is_named && !is_ladder && !study.empty() && study.find('/') == std::string::npos &&
      !std::filesystem::is_directory(study))
    fail(ErrorCode::bad_argument, "--study ", study,
         ": is none of h, kind and steps, and no folder "
         "of this name is there; name a new folder ./",
         study);
  if (is_ladder) options.request.source = study;
  if (!is_named && !is_ladder && options.plot.empty()) options.plot = study;
  options.study = is_named ? study : "h";
}

}  // namespace

bool read_options(tess::CommandLine& line, DriverOptions& options, int argc, char** argv) {
  std::string study;
  add_options(line, options, study);
  if (!line.parse(argc, argv)) return false;
  options.line = &line;
  options.kind_is_given = line.is_given("--kind");
  options.partition_is_given = line.is_given("--partition");
  if (line.is_given("--chares") && line.is_given("--per-pe"))
    fail(ErrorCode::bad_argument, "--chares ", options.request.n_chares, " and --per-pe ",
         options.request.per_pe, " both say how many chares there are; give one");
  if (line.is_given("--study")) read_study(study, options);
  return true;
}

}  // namespace m2m_transfer
