#include "apps/overset/report.hpp"

#include "apps/kit/chart.hpp"
#include "apps/kit/json.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/overset/picture.hpp"
#include "m2m/write_exodus.hpp"

#include <cmath>
#include <fmt/format.h>

namespace overset {
namespace {

using tess::m2m::BlankingReport;
using tess::m2m::Orphan;

constexpr std::array names{"background", "overset"};

}  // namespace

std::string table(const Request& request, const Problem& problem, const Assembly& assembly) {
  std::string out = fmt::format("{} with {} in it; wall: {} triangles", request.background,
                                request.overset, problem.wall.n_triangles());
  if (const auto& rim = problem.wall.rim(); rim.n_edges > 0)
    out += fmt::format(", {} holes capped, {:.2g} of the area", rim.n_loops, rim.cap_share);
  if (!problem.wall_remarks.empty()) out += fmt::format(" ({})", problem.wall_remarks);
  for (std::size_t i = 0; i < 2; ++i)
    if (const std::string skipped = skipped_text(problem.meshes[i]); !skipped.empty())
      out += fmt::format("\n  skipped in {}: {}", names[i], skipped);
  out += fmt::format("\n  {:<11}{:>9}{:>9}{:>9}{:>9}{:>15}{:>14}{:>11}\n", "", "field", "hole",
                     "fringe", "orphans", "least quality", "full quality", "max error");
  for (std::size_t i = 0; i < 2; ++i) {
    const Assembled& mesh = assembly.meshes[i];
    const BlankingReport& r = mesh.report;
    out +=
        fmt::format("  {:<11}{:>9}{:>9}{:>9}{:>9}{:>15.3f}{:>14}{:>11.3e}\n", names[i], r.n_field,
                    r.n_hole, r.n_fringe, r.n_orphans, r.least_quality, r.n_full, mesh.linf);
  }
  out += fmt::format("  seconds: cut {:.4f}, search {:.4f}, exchange {:.4f}; hash {:016x}\n",
                     assembly.cut, assembly.search, assembly.exchange, assembly.hash);
  for (std::size_t i = 0; i < 2; ++i) {
    const BlankingReport& r = assembly.meshes[i].report;
    for (std::size_t k = 0; k < std::min<std::size_t>(r.orphans.size(), 10); ++k) {
      const Orphan& orphan = r.orphans[k];
      out += fmt::format("  orphan: {} point {} at ({:.6g}, {:.6g}, {:.6g}): {}\n", names[i],
                         orphan.point, orphan.at[0], orphan.at[1], orphan.at[2],
                         name_of(orphan.reason));
    }
    if (r.n_orphans > 10)
      out +=
          fmt::format("  {} more orphans: --json lists {}\n", r.n_orphans - 10, r.orphans.size());
  }
  return out;
}

std::string json(const Request& request, const Problem& problem, const Assembly& assembly) {
  kit::Json out{
      {"background", request.background},
      {"overset", request.overset},
      {"wall",
       {{"triangles", problem.wall.n_triangles()},
        {"holes_capped", problem.wall.rim().n_loops},
        {"cap_share", problem.wall.rim().cap_share}}},
      {"field", problem.field},
      {"layers", problem.options.fringe_layers},
      {"chares", problem.n_parts},
      {"seconds",
       {{"cut", assembly.cut}, {"search", assembly.search}, {"exchange", assembly.exchange}}},
      {"result_hash", fmt::format("{:016x}", assembly.hash)}};
  for (std::size_t i = 0; i < 2; ++i) {
    const Assembled& mesh = assembly.meshes[i];
    const BlankingReport& r = mesh.report;
    kit::Json of_mesh{{"name", names[i]},         {"field", r.n_field},
                      {"hole", r.n_hole},         {"fringe", r.n_fringe},
                      {"orphans", r.n_orphans},   {"least_quality", r.least_quality},
                      {"full_quality", r.n_full}, {"linf", mesh.linf},
                      {"rms", mesh.rms},          {"orphan_list", kit::Json::array()}};
    for (const Orphan& orphan : r.orphans)
      of_mesh["orphan_list"].push_back(
          {{"point", orphan.point}, {"at", orphan.at}, {"reason", name_of(orphan.reason)}});
    out["meshes"].push_back(std::move(of_mesh));
  }
  return kit::json_text(out);
}

std::string explanation(const Problem& problem) {
  return fmt::format(
      "wall      {} triangles. A background point is a hole if the winding number of the wall\n"
      "          there is not 0, or if it lies on the wall. Decided by exact predicates.\n"
      "fringe    {} layer(s): background points within as many edges of a hole; overset points on\n"
      "          the outer boundary and as many layers inwards. Each piece has a halo as deep, so\n"
      "          this needs no message. Pieces get only the triangles that they see.\n"
      "donors    two searches, one in each direction. A donor is refused if a corner with a "
      "weight\n"
      "          is a hole, or if its quality is below {}. Quality: the sum of the weights at\n"
      "          field points. A fringe point without a donor is an orphan.\n"
      "error     |interpolated - {}| at the fringe.\n"
      "iblank    0 hole, 1 field, -1 from the background, -2 from the overset mesh, 101 orphan\n",
      problem.wall.n_triangles(), problem.options.fringe_layers, problem.options.least_quality,
      problem.field);
}

std::string write(const Problem& problem, const Assembly& assembly, const std::string& folder) {
  kit::make_folder("--plot", folder);
  for (std::size_t i = 0; i < 2; ++i) {
    const Assembled& mesh = assembly.meshes[i];
    const std::array<tess::m2m::Field, 3> fields{
        {{"iblank", 1, {mesh.iblank.begin(), mesh.iblank.end()}},
         {"quality", 1, mesh.quality},
         {"value", 1, mesh.values}}};
    write_exodus(fmt::format("{}/{}.exo", folder, names[i]), problem.meshes[i], fields);
  }
  kit::write_file(folder + "/before.svg", picture(problem, assembly, Moment::before));
  kit::write_file(folder + "/after.svg", picture(problem, assembly, Moment::after));
  return fmt::format("wrote before.svg, after.svg, background.exo and overset.exo to {}\n", folder);
}

std::string study_table(const std::vector<StudyRow>& rows, const std::string& folder) {
  std::string out = fmt::format("{:>6}{:>10}{:>11}{:>9}{:>9}{:>12}{:>12}{:>8}\n", "n", "h",
                                "seconds", "fringe", "orphans", "rms", "max error", "order");
  kit::Chart chart{.title = "error at the fringe",
                   .x_label = "seconds: cut, search, exchange",
                   .y_label = "error",
                   .x_log = true,
                   .y_log = true};
  chart.series = {{"rms"}, {"max"}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const StudyRow& r = rows[i];
    const std::string order = i == 0 ? ""
                                     : fmt::format("{:.2f}", std::log(rows[i - 1].rms / r.rms) /
                                                                 std::log(rows[i - 1].h / r.h));
    out += fmt::format("{:>6}{:>10.5f}{:>11.4f}{:>9}{:>9}{:>12.3e}{:>12.3e}{:>8}\n", r.n, r.h,
                       r.seconds, r.n_fringe, r.n_orphans, r.rms, r.linf, order);
    chart.series[0].points.push_back({r.seconds, r.rms});
    chart.series[1].points.push_back({r.seconds, r.linf});
  }
  if (folder.empty()) return out;
  kit::make_folder("--plot", folder);
  if (kit::write_svg(folder + "/study.svg", chart))
    out += fmt::format("wrote study.svg and study.csv to {}\n", folder);
  return out;
}

}  // namespace overset
