// Meshes around bodies overlap a background mesh: cuts the holes, finds the donors of the fringes,
// and moves a field between the meshes.
#include "apps/kit/driver.hpp"
#include "apps/kit/worst.hpp"
#include "apps/overset/body.hpp"
#include "apps/overset/report.hpp"
#include "apps/overset/wall_study.hpp"
#include "runtime/core/number.hpp"
#include "runtime/runtime.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace overset {
namespace {

struct Options {
  Request request;
  Problem problem;  // without the meshes
  std::string plot, study;
  std::vector<std::int32_t> refinements;  ///< of --study h: cubes on an edge of the background
  std::string body;                       ///< of a study: "ball"
};

constexpr kit::Modes wall_mode = kit::Mode::own(0);

Problem problem_of(const Options& options) {
  Problem problem = read_problem(options.request);
  problem.field = options.problem.field;
  problem.options.fringe_layers = options.problem.options.fringe_layers;
  problem.options.least_quality = options.problem.options.least_quality;
  problem.n_parts = options.problem.n_parts > 0 ? options.problem.n_parts : 2 * tess::n_pes();
  return problem;
}

tess::Task run_once(const Options& options, kit::Driver& driver) {
  const Problem problem = problem_of(options);
  if (driver.explains()) tess::print(explanation(problem));
  driver.progress().phase("assembly");
  const Assembly assembly = co_await assemble(problem);
  driver.progress().clear();
  tess::print(table(options.request, problem, assembly));
  driver.write(std::array{report(problem, assembly)});
  if (options.plot.empty()) co_return;
  write(problem, assembly, options.plot);
  tess::print("wrote before.svg, after.svg, background.exo and overset.exo",
              options.request.overset.size() > 1 ? " and more" : "", " to ", options.plot, "\n");
}

/// Both meshes refined together: the background of n cubes, the mesh around the body of n / 2
/// edges.
tess::Task run_refined(Options options, kit::Driver& driver) {
  std::vector<StudyRow> rows;
  tess::print_text(study_report().head());
  for (const std::int32_t n : options.refinements) {
    driver.progress().phase("assembly");
    driver.progress().part(rows.size() + 1, options.refinements.size());
    options.request.background = fmt::format("kuhn:{}", n);
    options.request.overset = {fmt::format("{}:{}", options.body, n / 2)};
    const Problem problem = problem_of(options);
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
    if (!rows.empty())
      row.order = kit::order_between({rows.back().h, rows.back().rms}, {row.h, row.rms});
    rows.push_back(row);
    driver.progress().clear();
    tess::print_text(study_report().line(row));
  }
  driver.write(study_report().json(rows));
  if (!options.plot.empty() && kit::write_svg(options.plot + "/study.svg", chart_of(rows)))
    tess::print("wrote study.svg and study.csv to ", options.plot, "\n");
}

tess::Task time_wall(const Options& options, kit::Driver& driver) {
  driver.progress().phase("inside tests");
  const std::vector<WallRow> rows = wall_study(options.body);
  driver.progress().clear();
  tess::print_text(wall_report().table(rows));
  driver.write(wall_report().json(rows));
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
void read_study(Options& options, kit::Driver& driver) {
  const std::string study = "--study " + options.study;
  driver.enter(options.study == "h" ? kit::Mode::study : wall_mode, study);
  std::string& background = options.request.background;
  bool has_background = driver.is_given("BACKGROUND");
  options.body = driver.is_given("OVERSET")
                     ? fmt::format("{}", fmt::join(options.request.overset, " "))
                     : "ball";
  if (has_background && !driver.is_given("OVERSET") && names_shape(background)) {
    options.body = background;
    has_background = false;
  }
  if (!names_shape(options.body))
    tess::fail(tess::ErrorCode::bad_argument, "--study: OVERSET ", options.body,
               " cannot be refined; give ball, box, star or torus without a number, as the study "
               "chooses the sizes");
  if (driver.mode() == wall_mode && has_background)
    tess::refuse_together("BACKGROUND " + background, study);
  options.refinements =
      has_background ? refinements_of(background) : std::vector<std::int32_t>{16, 24, 32, 48, 64};
}

/// Throws Error (bad_argument) where a file would replace an input or another output.
void check_files(const Options& options, kit::Driver& driver) {
  kit::FileNames& files = driver.files();
  if (options.study.empty()) {
    files.reads("BACKGROUND", options.request.background);
    for (const std::string& name : options.request.overset) files.reads("OVERSET", name);
    files.reads("--wall", options.request.wall);
  }
  if (options.plot.empty()) return;
  const std::string what = "--plot " + options.plot + ":";
  if (!options.study.empty()) return files.writes_picture(what, options.plot + "/study.svg");
  for (const char* file : {"background.exo", "overset.exo", "before.svg", "after.svg"})
    files.writes(what, options.plot + "/" + file);
  for (std::size_t k = 2; k <= options.request.overset.size(); ++k)
    files.writes(what, fmt::format("{}/overset{}.exo", options.plot, k));
}

int run(tess::Setup& setup, int argc, char** argv) {
  Options options;
  options.problem.n_parts = 0;
  tess::m2m::BlankingOptions& blanking = options.problem.options;
  using kit::Mode;
  kit::Driver driver(setup,
                     "Cuts the hole of a body into a background mesh and couples it with the mesh "
                     "around the body.");
  driver.option(
      "BACKGROUND", options.request.background,
      "mesh: an ExodusII, gmsh or VTU file, or kuhn:N, the unit cube of 6 N^3 tetrahedra; with "
      "--study h a ladder such as kuhn:16,24,32");
  driver.option(
      "OVERSET", options.request.overset,
      "mesh around a body: a file, or ball:N, box:N, star:N, torus:N, as ball:12@X:Y:Z:RADIUS "
      "in another place; with --study ball, box, star or torus. Each further one is "
      "another body");
  driver.json("write the report and the orphans, or the rows of a study, to this file");
  driver
      .option("--study", options.study,
              "h: refine both meshes; error at the fringe against run time. wall: time of the "
              "inside test against the size of the wall")
      .one_of({"h", "wall"});
  driver.in(Mode::run | Mode::study);
  driver.option("--field FORMULA", options.problem.field,
                "gaussian, linear, sin, or an expression in x, y, z");
  driver.option("--layers", blanking.fringe_layers, "layers of fringe points").between(1, 8);
  driver
      .option("--least-quality", blanking.least_quality,
              "donors below it are refused: 0 to 1, 1 for donors of computed values only")
      .between(0, 1);
  driver.option("--chares", options.problem.n_parts, "pieces per mesh (default: two per PE)")
      .between(1, 1 << 16);
  driver.folder("--plot DIR", options.plot,
                "write pictures before and after, and ExodusII files, or the picture of a study, "
                "to this folder");
  driver.in(Mode::run);
  driver.option("--wall WALL", options.request.wall,
                "the wall: a side set of OVERSET (its name, or its number if it has none), or an "
                "OBJ, PLY or STL file (default: the cavities of OVERSET)");
  driver
      .option("--symmetry PLANES", options.request.symmetry,
              "sides of BACKGROUND that are planes of symmetry, on which bodies stand: z=0, or "
              "z=0,y=0, or "
              "0.6:0.8:0=2 for 0.6 x + 0.8 y = 2")
      .separated_by(',');
  driver.explain("print what this run does, step by step");
  driver.examples({"kuhn:16 ball:8 --plot pictures", "kuhn:16 star:8 --layers 2 --pes 2 --explain",
                   "kuhn:8,16 box --study h"});
  if (!driver.parse(argc, argv)) return 0;
  if (!options.study.empty()) read_study(options, driver);
  check_files(options, driver);
  return tess::run(setup, [&] {
    if (options.study.empty()) return run_once(options, driver);
    return options.study == "h" ? run_refined(options, driver) : time_wall(options, driver);
  });
}

}  // namespace
}  // namespace overset

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return overset::run(setup, argc, argv); });
}
