// A mesh around a body overlaps a background mesh: cuts the hole, finds the donors of the fringes,
// and moves a field between the two.
#include "apps/kit/file_names.hpp"
#include "apps/kit/worst.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/overset/body.hpp"
#include "apps/overset/report.hpp"
#include "apps/overset/wall_study.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/number.hpp"
#include "runtime/runtime.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace overset {
namespace {

struct Options {
  Request request;
  Problem problem;  // without the meshes
  std::string json, plot, study;
  bool explain = false;
  std::vector<std::int32_t> refinements;    ///< of --study h: cubes on an edge of the background
  std::string body;                         ///< of a study: "ball"
  std::vector<std::string> given_for_once;  ///< options of a run that --study wall does not use
};

tess::Task run_once(Options options) {
  Problem problem = read_problem(options.request);
  problem.field = options.problem.field;
  problem.options = options.problem.options;
  problem.n_parts = options.problem.n_parts > 0 ? options.problem.n_parts : 2 * tess::n_pes();
  if (options.explain) tess::print(explanation(problem));
  const Assembly assembly = co_await assemble(problem);
  tess::print(table(options.request, problem, assembly));
  if (!options.json.empty())
    kit::write_file(options.json, json(options.request, problem, assembly));
  if (!options.plot.empty()) tess::print(write(problem, assembly, options.plot));
}

/// Both meshes refined together: the background of n cubes, the mesh around the body of n / 2
/// edges.
tess::Task run_refined(Options options) {
  std::vector<StudyRow> rows;
  for (const std::int32_t n : options.refinements) {
    options.request.background = fmt::format("kuhn:{}", n);
    options.request.overset = fmt::format("{}:{}", options.body, n / 2);
    Problem problem = read_problem(options.request);
    problem.field = options.problem.field;
    problem.options = options.problem.options;
    problem.n_parts = options.problem.n_parts > 0 ? options.problem.n_parts : 2 * tess::n_pes();
    const Assembly assembly = co_await assemble(problem);
    StudyRow row{
        .n = n, .h = 1.0 / n, .seconds = assembly.cut + assembly.search + assembly.exchange};
    double squares = 0;
    for (const Assembled& mesh : assembly.meshes) {
      kit::worsen(row.linf, mesh.linf);
      squares += mesh.rms * mesh.rms * static_cast<double>(mesh.report.n_fringe);
      row.n_fringe += mesh.report.n_fringe;
      row.n_orphans += mesh.report.n_orphans;
    }
    row.rms = std::sqrt(squares / static_cast<double>(row.n_fringe));
    rows.push_back(row);
  }
  tess::print(study_table(rows, options.plot));
}

tess::Task time_wall(Options options) {
  tess::print(wall_study(options.body));
  co_return;
}

/// The numbers of "kuhn:16,24,32".
std::vector<std::int32_t> refinements_of(const std::string& background) {
  std::vector<std::int32_t> out;
  std::string_view text = background;
  bool more = text.starts_with("kuhn:");
  if (more) text.remove_prefix(5);
  while (more) {
    const std::int32_t n = tess::take_number<std::int32_t>(text).value_or(0);
    if (n < 4 || n > 400 || n % 2 != 0 || (!out.empty() && n <= out.back())) break;
    out.push_back(n);
    more = text.starts_with(',');
    if (more) text.remove_prefix(1);
  }
  if (more || !text.empty() || out.size() < 2)
    tess::fail(tess::ErrorCode::bad_argument, "--study h: BACKGROUND ", background,
               " is no ladder; give two or more even numbers from 4 to 400 in ascending order, as "
               "in kuhn:16,24,32");
  return out;
}

/// Takes BACKGROUND and OVERSET of a study, where a body without a number can stand alone.
void read_study(Options& options, bool has_background, bool has_overset) {
  std::string& background = options.request.background;
  std::string& body = options.request.overset;
  if (has_background && !has_overset && names_shape(background)) {
    body = background;
    has_background = false;
    has_overset = true;
  }
  if (!has_overset) body = "ball";
  if (!names_shape(body))
    tess::fail(tess::ErrorCode::bad_argument, "--study: OVERSET ", body,
               " cannot be refined; give ball, box, star or torus without a number, as the study "
               "chooses the sizes");
  options.body = body;
  if (options.study == "h")
    options.refinements =
        has_background ? refinements_of(background) : std::vector<std::int32_t>{16, 24, 32, 48, 64};
  else if (has_background)
    options.given_for_once.insert(options.given_for_once.begin(), "BACKGROUND " + background);
}

/// Throws Error (bad_argument) for an option that a study does not use, and where a file would
/// replace an input or another output. `trace`: that of the runtime's option.
void refuse_contradictions(const Options& options, const std::string& trace) {
  const std::string study = "--study " + options.study;
  const auto refuse = [&](const std::string& option) { tess::refuse_together(option, study); };
  if (!options.study.empty()) {
    if (!options.json.empty()) refuse("--json " + options.json);
    if (!options.request.wall.empty()) refuse("--wall " + options.request.wall);
    if (options.explain) refuse("--explain");
    if (options.study == "wall" && !options.plot.empty()) refuse("--plot " + options.plot);
    if (options.study == "wall" && !options.given_for_once.empty())
      refuse(options.given_for_once.front());
    return;
  }
  kit::FileNames names;
  names.reads("BACKGROUND", options.request.background);
  names.reads("OVERSET", options.request.overset);
  names.reads("--wall", options.request.wall);
  names.writes("--trace", trace);
  names.writes("--json", options.json);
  for (const char* file : {"background.exo", "overset.exo", "before.svg", "after.svg"})
    if (!options.plot.empty())
      names.writes("--plot " + options.plot + ":", std::filesystem::path(options.plot) / file);
}

int run(tess::Setup& setup, int argc, char** argv) {
  Options options;
  options.problem.n_parts = 0;
  tess::CommandLine line(
      "Cuts the hole of a body into a background mesh and couples it with the mesh around the "
      "body.");
  line.option(
      "BACKGROUND", options.request.background,
      "mesh: an ExodusII, gmsh or VTU file, or kuhn:N, the unit cube of 6 N^3 tetrahedra; with "
      "--study h a ladder such as kuhn:16,24,32");
  line.option("OVERSET", options.request.overset,
              "mesh around a body: a file, or ball:N, box:N, star:N, torus:N; with --study ball, "
              "box, star or torus");
  line.option("--wall WALL", options.request.wall,
              "the wall: a side set of OVERSET (its name, or its number if it has none), or an "
              "OBJ, PLY or STL file (default: the cavities of OVERSET)");
  line.option("--field FORMULA", options.problem.field,
              "gaussian, linear, sin, or an expression in x, y, z");
  line.option("--layers", options.problem.options.fringe_layers, "layers of fringe points")
      .between(1, 8);
  line.option("--least-quality", options.problem.options.least_quality,
              "donors below it are refused: 0 to 1, 1 for donors of computed values only");
  line.option("--chares", options.problem.n_parts, "pieces per mesh (default: two per PE)")
      .between(1, 1 << 16);
  line.option("--json FILE", options.json, "write the report and the orphans to this file");
  line.option("--plot DIR", options.plot,
              "write pictures before and after, and ExodusII files, to this folder");
  line.flag("--explain", options.explain, "print what this run does, step by step");
  line.option("--study", options.study,
              "h: refine both meshes; error at the fringe against run time. wall: time of the "
              "inside test against the size of the wall")
      .one_of({"h", "wall"});
  if (!line.parse(argc, argv)) return 0;
  const double least = options.problem.options.least_quality;
  if (!(least >= 0 && least <= 1))
    tess::fail(tess::ErrorCode::bad_argument, "--least-quality: ", least, " is not from 0 to 1");
  kit::require_writable("--json", options.json);
  for (const char* option : {"--field", "--layers", "--least-quality", "--chares"})
    if (line.is_given(option)) options.given_for_once.emplace_back(option);
  if (!options.study.empty())
    read_study(options, line.is_given("BACKGROUND"), line.is_given("OVERSET"));
  refuse_contradictions(options, setup.options.trace);
  return tess::run(setup, [&] {
    if (options.study.empty()) return run_once(options);
    return options.study == "h" ? run_refined(options) : time_wall(options);
  });
}

}  // namespace
}  // namespace overset

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return overset::run(setup, argc, argv); });
}
