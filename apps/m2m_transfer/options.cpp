#include "apps/m2m_transfer/options.hpp"

#include "apps/m2m_transfer/study/study.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/core/error.hpp"

#include <filesystem>
#include <set>
#include <utility>

namespace m2m_transfer {
namespace {

/// "linear, second-order, …"
std::string kind_names() {
  std::string out;
  for (const tess::m2m::TransferKind kind : tess::m2m::all_transfer_kinds)
    out += (out.empty() ? "" : ", ") + std::string(name_of(kind));
  return out;
}

/// One run of formulas, by one kind or by all.
constexpr kit::Modes runs = Mode::run | Mode::all_kinds;
constexpr kit::Modes studies = Mode::study | Mode::steps | Mode::pes;
/// A search finds the donors, with options for it.
constexpr kit::Modes searches = runs | studies | Mode::files | Mode::round_trips;
constexpr kit::Modes file_modes = Mode::files | Mode::from_weights;

void add_meshes(kit::Driver& driver, Request& request) {
  driver.option("SOURCE", request.source,
                "mesh: an ExodusII, gmsh (2.0 to 4.1) or VTK file (.vtu, .pvtu, .vtk) of "
                "tetrahedra and other "
                "solids, of surfaces or of lines; or kuhn:N, a generated box of 6 N^3 tetrahedra");
  driver.option("TARGET", request.target, "mesh of the same kinds");
  driver.in(runs | file_modes);
  driver.option("--source-part NAME", request.source_part,
                "a surface of SOURCE as the source: its skin, a side set by name or number, or a "
                "block likewise, whose skin it is if it is of solids (ExodusII and gmsh files)");
  driver.option("--target-part NAME", request.target_part, "a part of TARGET likewise");
  driver.in(runs);
  driver.option("MORE", request.more, "further meshes of the same kinds, for --pairs");
}

void add_transfer(kit::Driver& driver, Options& options) {
  FileFieldsRequest& request = options.request;
  driver.group("Transfer");
  driver.in(searches | Mode::from_weights);
  driver.option(
      "--fields,--field NAMES", request.fields,
      "gaussian, linear, sin, an expression in x, y, z, or a field of the source file at vertices "
      "or in elements (moved to the target's elements); several as --fields sin,x*y");
  driver.in(searches);
  driver.option(
      "--kind KIND", request.kind,
      "how values follow from the source: " + kind_names() + "; all: a table with a row per kind");
  driver.in(runs);
  driver
      .option("--pairs A:B,B:C", request.pairs,
              "which mesh gives values to which, by letter (A is SOURCE, B is TARGET) or file. "
              "Pairs run in the order given where they share a mesh that is written, otherwise at "
              "once")
      .joined_by(',');
  driver.in(Mode::all);
  driver.option("--policy POLICY", options.policies,
                "value of vertices outside the source: keep, value:V or nearest");
  driver.in(searches);
  driver.option(
      "--tolerance LENGTH", request.tolerance,
      "vertices outside the source but nearer than this snap to it; walls overlap within it");
  driver.flag("--clamp", request.clamp, "keep values within those of the donor's vertices");
  driver.option("--order", request.order, "of the polynomials of moving least squares")
      .between(1, 2);
  driver.in(runs | Mode::files);
  driver
      .option("--steps", request.steps,
              "applications of all pairs, with the donors of one search; the time of the fastest "
              "counts. With fields of files: the steps of --move up to the first one moved")
      .between(1, 1000000);
  driver.option("--move MOTION", request.moves,
                "move a mesh before every step but the first, and search again: "
                "'B:rotate(0,0,1,5deg)' about its middle, 'B:rotate(0,0,1,5deg,0,0,0)' about a "
                "point, or 'B:translate(0.1,0,0)'; repeat for several");
  driver.in(Mode::files);
  driver.option(
      "--vector NAME", request.vectors,
      "a field of three components in the frame of SOURCE, such as v of v_x, v_y and v_z: "
      "it turns with the rotations of --move A:…; repeat for several");
  driver.enters("--vector", Mode::files);
  driver.in(file_modes);
  driver.option("--step N|all", request.step,
                "step of the fields that the source file has, from 0 on, or all (default: the "
                "last); --out then holds all steps");
  driver.option("--from-weights FILE", request.from_weights,
                "transfer with the weights of this file, without a search");
  driver.enters("--step", Mode::files);
  driver.enters("--from-weights", Mode::files);
}

void add_chares(kit::Driver& driver, Request& request) {
  driver.group("Chares");
  driver.in(searches);
  driver
      .option("--chares", request.n_chares,
              "chares per mesh (default: --per-pe times the number of PEs)")
      .between(1, 1 << 20);
  driver.option("--per-pe", request.per_pe, "chares per mesh and PE").between(1, 1 << 20);
  driver
      .option("--voxel LENGTH", request.voxel, "edge of a voxel (default: chosen from the meshes)")
      .positive();
  driver.in(searches | Mode::stability);
  driver.option("--partition METHOD", request.partition,
                "how the meshes are cut into chares: curve (by all PEs together), rcb or hsfc");
}

void add_output(kit::Driver& driver, Options& options) {
  driver.group("Output");
  driver.in(Mode::run | file_modes);
  driver.option(
      "--out FILE", options.request.out,
      "write the target mesh with the fields and the status (transfer_status if a field is called "
      "status): ExodusII if it ends in .exo, .e, "
      ".ex2, .g, .exii, .gen or .ncdf, VTU if in .vtu, a VTU file per step if in .pvd, VTU written "
      "by all processes, a file per "
      "chare, if in .pvtu; with several targets to FILE.B.exo, FILE.C.exo");
  driver.in(Mode::files);
  driver.option("--weights FILE", options.request.weights,
                "write the weights of the transfer (NetCDF, ESMF's layout)");
  driver.enters("--weights", Mode::files);
  driver.option("--watch X,Y,Z", options.request.watch,
                "report the values of the source at this point in every step; repeat for several");
  driver.enters("--watch", Mode::files);
  driver.option("--watch-file FILE", options.request.watch_file,
                "write the values of --watch as CSV (default: a table in the report)");
  driver.in(Mode::run);
  driver.option("--picture FILE", options.picture,
                "draw the first field and its error in a cut through the target, as SVG");
  driver.json("write the report as JSON");
  driver.in(runs | Mode::study);
  driver.option("--reference radial-basis", options.reference,
                "one more row: the error and time of radial basis interpolation on one PE, from at "
                "most 20 000 vertices");
  driver.explain("print what this transfer uses and what it leaves out");
}

void add_studies(kit::Driver& driver, Options& options) {
  driver.group("Studies");
  driver.in(runs | studies);
  driver
      .option("--repeat", options.repeat,
              "number of transfers; the times are those of the fastest (default: 1, with --study "
              "3)")
      .between(1, 1000000);
  driver.in(studies);
  driver
      .option("--study WHAT", options.study,
              "h: error against run time over several meshes (default); kind: the same for every "
              "kind; steps: the time that kept donors save; pes: run time on simulated machines of "
              "more and more PEs. SOURCE and TARGET can be ladders such "
              "as kuhn:8,16,32@0.2 or a.msh,b.msh; --policy can be repeated. A folder (as --plot; "
              "./NAME if it is new) or a ladder without TARGET can stand in place of h")
      .takes(0, 1);
  driver.enters("--study", Mode::study);
  driver.enters("--study", Mode::steps, "steps");
  driver.enters("--study", Mode::pes, "pes");
  driver.in(Mode::pes);
  driver.option("--machines N,N,…", options.pes, "PEs of the machines of --study pes")
      .separated_by(',')
      .between(1, 1 << 20);
  driver.option("--network KEYS", options.sim, "what else --sim would say of these machines");
  driver.in(Mode::round_trips);
  driver.option("--round-trips N,N,…", options.round_trips,
                "SOURCE to TARGET and back with one pair of handles, and the drift after so many "
                "trips; for all kinds, or the --kind given");
  driver.enters("--round-trips", Mode::round_trips);
  driver.in(studies | Mode::round_trips);
  driver.option("--plot DIR", options.plot,
                "write the table of --study or --round-trips as CSV, JSON and SVG to this folder");
  driver.stability(
      "extreme meshes and points, and the same of SOURCE and TARGET where they are given: points "
      "lost, error, bits; --policy and --partition (default: rcb) hold for every case");
}

/// What follows `--study`: the name of a study, a ladder of meshes or the folder of `--plot`.
void read_study(Options& options) {
  const std::string given = options.study;
  const bool is_named = given == "h" || given == "kind" || given == "steps" || given == "pes";
  const bool is_ladder = given.starts_with("kuhn:") && options.request.source.empty();
  // A folder has a '/' unless it is there already: a word may be the name of a study, mistyped.
  if (!is_named && !is_ladder && !given.empty() && given.find('/') == std::string::npos &&
      !std::filesystem::is_directory(given))
    fail(ErrorCode::bad_argument, "--study ", given,
         ": is none of h, kind, steps and pes, and no folder "
         "of this name is there; name a new folder ./",
         given);
  if (is_ladder) options.request.source = given;
  if (!is_named && !is_ladder && options.plot.empty()) options.plot = given;
  if (!is_named) options.study = "h";
}

/// What the modes do not say.
void check_values(const kit::Driver& driver, const Options& options) {
  const Request& request = options.request;
  for (const auto& [option, part] : {std::pair("--source-part", request.source_part),
                                     std::pair("--target-part", request.target_part)})
    if (driver.is_given(option) && part.empty())
      fail(ErrorCode::bad_argument, option,
           " '' names no part; give a name or a number, or leave the option out");
  driver.refuse_both("--chares", "--per-pe");
  driver.refuse_both("--steps", "--weights");  // these are of one place
  driver.refuse_both("--move", "--weights");
  const bool has_all_kinds = request.kind == "all" || options.study == "kind" ||
                             (driver.mode() == Mode::round_trips && !driver.is_given("--kind"));
  if (request.order != 1 && request.kind != "moving-least-squares" && !has_all_kinds)
    fail(ErrorCode::bad_argument, "--order ", request.order,
         " is for kind moving-least-squares, not ", request.kind,
         "; leave it out, or give that --kind");
  if (options.request.watch.empty())
    driver.line().refuse_without("--watch X,Y,Z", {"--watch-file"});
  driver.refuse_both("--reference", "--pairs");
  driver.refuse_both("--reference", "--move");
  if (!options.reference.empty() && options.reference != "radial-basis")
    fail(ErrorCode::bad_argument, "--reference ", options.reference,
         " is unknown; choose radial-basis");
  if (request.moves.empty()) driver.line().refuse_without("--move A:rotate(…)", {"--vector"});
  if (request.steps == 1 && options.request.step != "all")
    driver.line().refuse_without("--steps above 1", {"--move"});
  if (options.policies.size() > 1 && driver.mode() != Mode::study)
    fail(ErrorCode::bad_argument, "--policy is given more than once; give it once, or add --study");
  std::set<std::string> names;
  for (const std::string& name : split_names(request.fields))  // results are written by name
    if (!names.insert(name).second)
      fail(ErrorCode::bad_argument, "--fields: ", name, " is given twice; give it once");
}

void take_files(kit::FileNames& files, const Options& options) {
  const FileFieldsRequest& request = options.request;
  for (const std::string& mesh : request.more) files.reads("a mesh", mesh);
  for (const std::string& mesh : expand(request.source)) files.reads("SOURCE", mesh);
  for (const std::string& mesh : expand(request.target)) files.reads("TARGET", mesh);
  files.reads("--from-weights", request.from_weights);
  files.writes("--out", request.out);
  files.writes("--picture", options.picture);
  files.writes("--weights", request.weights);
  files.writes("--watch-file", request.watch_file);
}

}  // namespace

bool read_options(kit::Driver& driver, Options& options, int argc, char** argv) {
  add_meshes(driver, options.request);
  add_transfer(driver, options);
  add_chares(driver, options.request);
  add_output(driver, options);
  add_studies(driver, options);
  driver.examples({"kuhn:8 kuhn:9 --fields sin --pes 2 --explain", "kuhn:8@0.2 kuhn:9 --kind all",
                   "kuhn:8 kuhn:9 --out moved.exo --picture cut.svg",
                   "kuhn:4,8@0.2 --study h --fields sin --plot study"});
  if (!driver.parse(argc, argv)) return false;
  if (driver.is_given("--study")) read_study(options);
  check_values(driver, options);
  take_files(driver.files(), options);
  options.request.policy = options.policies.front();
  return true;
}

}  // namespace m2m_transfer
