#include "apps/overset/report.hpp"

#include "apps/kit/output/write_file.hpp"
#include "apps/overset/picture.hpp"
#include "m2m/write_exodus.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace overset {
namespace {

using tess::m2m::BlankingReport;
using tess::m2m::Orphan;

std::string mesh_name(std::size_t number) {
  if (number == 0) return "background";
  return number == 1 ? "overset" : fmt::format("overset{}", number);
}

/// Counts of all walls.
struct WallSums {
  std::size_t n_triangles = 0, n_capped = 0, n_on_symmetry = 0;
  double cap_share = 0;  ///< the largest
};
WallSums sums_of(const Problem& problem) {
  WallSums out;
  for (const tess::m2m::Wall& wall : problem.walls) {
    out.n_triangles += wall.n_triangles();
    out.n_capped += wall.rim().n_loops;
    out.n_on_symmetry += wall.rim().n_on_symmetry;
    out.cap_share = std::max(out.cap_share, wall.rim().cap_share);
  }
  return out;
}

struct MeshRow {
  std::string name;
  const Assembled& mesh;
};
using R = const MeshRow&;
using kit::Json;

template <auto member>
Json reported(R row) {
  return row.mesh.report.*member;
}
Json orphan_list(R row) {
  Json out = Json::array();
  for (const Orphan& orphan : row.mesh.report.orphans)
    out.push_back({{"point", orphan.point}, {"at", orphan.at}, {"reason", name_of(orphan.reason)}});
  return out;
}

constexpr kit::Column<MeshRow> mesh_columns[] = {
    {"name", "", "<10", kit::of<&MeshRow::name>},
    {"field", "field", "8", reported<&BlankingReport::n_field>},
    {"hole", "hole", "8", reported<&BlankingReport::n_hole>},
    {"fringe", "fringe", "8", reported<&BlankingReport::n_fringe>},
    {"orphans", "orphans", "8", reported<&BlankingReport::n_orphans>},
    {"least_quality", "least quality", "14.3f", reported<&BlankingReport::least_quality>},
    {"full_quality", "full quality", "13", reported<&BlankingReport::n_full>},
    {"linf", "max error", "10.3e", [](R r) -> Json { return r.mesh.linf; }},
    {"rms", "", nullptr, [](R r) -> Json { return r.mesh.rms; }},
    {"orphan_list", "", nullptr, orphan_list}};

std::vector<MeshRow> rows_of(const Assembly& assembly) {
  std::vector<MeshRow> rows;
  for (const Assembled& mesh : assembly.meshes) rows.push_back({mesh_name(rows.size()), mesh});
  return rows;
}

constexpr kit::Column<StudyRow> study_columns[] = {
    {"n", "n", "6", kit::of<&StudyRow::n>},
    {"h", "h", "9.5f", kit::of<&StudyRow::h>},
    {"seconds", "seconds", "10.4f", kit::of<&StudyRow::seconds>},
    {"fringe", "fringe", "8", kit::of<&StudyRow::n_fringe>},
    {"orphans", "orphans", "8", kit::of<&StudyRow::n_orphans>},
    {"rms", "rms", "11.3e", kit::of<&StudyRow::rms>},
    {"linf", "max error", "11.3e", kit::of<&StudyRow::linf>},
    {"order", "order", "7.2f", kit::of<&StudyRow::order>}};

}  // namespace

std::string table(const Request& request, const Problem& problem, const Assembly& assembly) {
  const WallSums wall = sums_of(problem);
  std::string out = fmt::format("{} with {} in it; wall: {} triangles", request.background,
                                fmt::join(request.overset, " and "), wall.n_triangles);
  if (wall.n_on_symmetry > 0) out += ", closed beyond " + text_of(problem.options.symmetry);
  if (wall.n_capped > 0)
    out += fmt::format(", {} holes capped, {:.2g} of the area", wall.n_capped, wall.cap_share);
  if (!problem.wall_remarks.empty()) out += fmt::format(" ({})", problem.wall_remarks);
  for (std::size_t i = 0; i < problem.meshes.size(); ++i)
    if (const std::string skipped = skipped_text(problem.meshes[i]); !skipped.empty())
      out += fmt::format("\n  skipped in {}: {}", mesh_name(i), skipped);
  out += '\n' + kit::Rows(mesh_columns).table(rows_of(assembly));
  out += fmt::format("  seconds: cut {:.4f}, search {:.4f}, exchange {:.4f}; hash {:016x}\n",
                     assembly.cut, assembly.search, assembly.exchange, assembly.hash);
  for (std::size_t i = 0; i < assembly.meshes.size(); ++i) {
    const BlankingReport& r = assembly.meshes[i].report;
    for (std::size_t k = 0; k < std::min<std::size_t>(r.orphans.size(), 10); ++k) {
      const Orphan& orphan = r.orphans[k];
      out += fmt::format("  orphan: {} point {} at ({:.6g}, {:.6g}, {:.6g}): {}\n", mesh_name(i),
                         orphan.point, orphan.at[0], orphan.at[1], orphan.at[2],
                         name_of(orphan.reason));
    }
    if (r.n_orphans > 10)
      out +=
          fmt::format("  {} more orphans: --json lists {}\n", r.n_orphans - 10, r.orphans.size());
  }
  return out;
}

Json report(const Problem& problem, const Assembly& assembly) {
  const WallSums wall = sums_of(problem);
  return {{"wall",
           {{"triangles", wall.n_triangles},
            {"holes_in_symmetry", wall.n_on_symmetry},
            {"holes_capped", wall.n_capped},
            {"cap_share", wall.cap_share}}},
          {"chares", problem.n_parts},
          {"seconds",
           {{"cut", assembly.cut}, {"search", assembly.search}, {"exchange", assembly.exchange}}},
          {"result_hash", kit::hex(assembly.hash)},
          {"meshes", kit::Rows(mesh_columns).json(rows_of(assembly))}};
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
      sums_of(problem).n_triangles, problem.options.fringe_layers, problem.options.least_quality,
      problem.field);
}

void write(const Problem& problem, const Assembly& assembly, const std::string& folder) {
  for (std::size_t i = 0; i < problem.meshes.size(); ++i) {
    const Assembled& mesh = assembly.meshes[i];
    const std::array<tess::m2m::Field, 3> fields{
        {{"iblank", 1, {mesh.iblank.begin(), mesh.iblank.end()}},
         {"quality", 1, mesh.quality},
         {"value", 1, mesh.values}}};
    write_exodus(fmt::format("{}/{}.exo", folder, mesh_name(i)), problem.meshes[i], fields);
  }
  kit::write_file(folder + "/before.svg", picture(problem, assembly, Moment::before));
  kit::write_file(folder + "/after.svg", picture(problem, assembly, Moment::after));
}

const kit::Rows<StudyRow>& study_report() {
  static const kit::Rows<StudyRow> rows(study_columns);
  return rows;
}

kit::Chart chart_of(const std::vector<StudyRow>& rows) {
  kit::Chart chart{.title = "error at the fringe",
                   .x_label = "seconds: cut, search, exchange",
                   .y_label = "error",
                   .x_log = true,
                   .y_log = true,
                   .series = {{"rms"}, {"max"}}};
  for (const StudyRow& row : rows) {
    chart.series[0].points.push_back({row.seconds, row.rms});
    chart.series[1].points.push_back({row.seconds, row.linf});
  }
  return chart;
}

}  // namespace overset
