#include "apps/collide_scene/study/voxels.hpp"

#include "apps/collide_scene/run/serial.hpp"
#include "apps/kit/output/write_file.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace collide_scene {
namespace {

/// The edge of voxels of which there are about as many as objects, which is positive: the base of
/// the ladder where the library uses no grid.
double edge_per_object(const Scene& scene) {
  auto all = tess::collide::no_box<double, 3>();
  for (const auto& box : boxes_of(scene)) all = merged(all, box);
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, all.hi[k] - all.lo[k]);
  return longest > 0 ? longest / std::cbrt(static_cast<double>(scene.n_objects())) : 1;
}

/// Measures a row, or notes why the library refuses it.
void measure(const Scene& scene, const Rules& rules, VoxelRow& row) {
  constexpr int n_runs = 3;
  try {
    for (int run = 0; run < n_runs; ++run) {
      const SerialCollision now = collide_once(scene, rules, 0);
      row.cpu_seconds = run == 0 ? now.cpu_seconds : std::min(row.cpu_seconds, now.cpu_seconds);
      row.grid = now.grid;
      row.answer = now.answer;
    }
  } catch (const tess::Error& error) {
    row.note = error.what();
    return;
  }
  row.ns_per_object = row.cpu_seconds * 1e9 / static_cast<double>(scene.n_objects());
  if (row.grid.counts.voxel_size > 0) row.voxel_size = row.grid.counts.voxel_size;
}

using R = const VoxelRow&;
using kit::Json, kit::of;

/// A number of the grid; none if the voxel size was refused.
template <auto member>
Json of_grid(R row) {
  return row.note.empty() ? Json(row.grid.counts.*member) : Json();
}
Json entries(R row) {
  return row.grid.counts.n_entries > 0 ? of_grid<&tess::collide::GridCounts::n_entries>(row)
                                       : Json();
}
Json percent_false(R row) {
  return row.note.empty() ? Json(100 * row.false_positive_rate) : Json();
}
Json ns_per_object(R row) {
  return row.note.empty() ? Json(row.ns_per_object) : Json();
}

using Counts = tess::collide::GridCounts;
constexpr kit::Column<VoxelRow> columns[] = {
    {"objects", "objects", "<10", of<&VoxelRow::objects>},
    {"factor", "factor", "7", of<&VoxelRow::factor>},
    {"voxel_size", "voxel size", "11.4g", of<&VoxelRow::voxel_size>},
    {"levels", "levels", "7", of_grid<&Counts::n_levels>},
    {"voxels", "voxels", "10", of_grid<&Counts::n_voxels>},
    {"entries", "entries", "11", of_grid<&Counts::n_entries>},
    {"left_out", "", nullptr, of_grid<&Counts::n_left_out>},
    {"candidates", "candidates", "12", [](R r) -> Json { return r.answer.n_candidates; }},
    {"pairs", "pairs", "12", [](R r) -> Json { return r.answer.n_pairs; }},
    {"false_positive_rate", "", nullptr, of<&VoxelRow::false_positive_rate>},
    {"", "false %", "8.2f", percent_false},
    {"bytes", "bytes", "12", [](R r) -> Json { return r.grid.bytes; }},
    {"cpu_seconds", "", nullptr, of<&VoxelRow::cpu_seconds>},
    {"cpu_ns_per_object", "CPU ns", "10.2f", ns_per_object},
    {"agrees", "", nullptr, of<&VoxelRow::agrees>},
    {"note", "", nullptr, of<&VoxelRow::note>},
    {"", "", "<", [](R r) -> Json {
       return !r.note.empty() ? "refused: " + r.note : r.agrees ? "" : "OTHER PAIRS";
     }}};

struct Picture {
  const char *file, *title, *x_label, *y_label;
  Json (*x)(R);
  Json (*y)(R);
  bool y_log;
  kit::Style style;
};
constexpr Picture pictures[] = {
    {"_study_time.svg", "time", "voxel size", "CPU ns per object", of<&VoxelRow::voxel_size>,
     ns_per_object, true, kit::Style::lines_points},
    {"_study_entries.svg", "objects in voxels", "voxel size", "(object, voxel)",
     of<&VoxelRow::voxel_size>, entries, true, kit::Style::lines_points},
    {"_study_error.svg", "error against run time, a point per voxel size", "CPU ns per object",
     "pairs that are none, %", ns_per_object, percent_false, false, kit::Style::points}};

}  // namespace

std::vector<VoxelRow> study_voxels(const Scene& scene, const Options& options,
                                   kit::Progress& progress) {
  constexpr std::array factors{1.0, 0.125, 0.25, 0.5, 2.0, 4.0, 8.0, 16.0};
  const std::uint32_t n_kinds = scene.triangles.empty() ? 1 : 2;
  std::vector<VoxelRow> rows;
  Answer reference;  // of the objects, that of the first row that is not refused
  bool has_reference = false;
  for (std::uint32_t kind = 0; kind < n_kinds; ++kind) {
    const std::size_t chosen = rows.size();
    has_reference = false;
    for (const double factor : factors) {
      progress.part(rows.size() + 1, n_kinds * factors.size());
      progress.phase("study: voxel sizes");
      VoxelRow row;
      row.objects = kind == 0 ? "boxes" : "triangles";
      row.factor = factor;
      Rules rules = options.rules;
      rules.triangles = kind == 1;
      // Whatever the options give: the first is the size that the library chooses.
      rules.voxel_size = row.voxel_size = factor == 1 ? 0 : factor * rows[chosen].voxel_size;
      measure(scene, rules, row);
      if (factor == 1 && !(row.voxel_size > 0)) row.voxel_size = edge_per_object(scene);
      if (row.note.empty() && !std::exchange(has_reference, true)) reference = row.answer;
      row.agrees = row.note.empty() && row.answer.has_pairs_of(reference);
      rows.push_back(row);
    }
  }
  // The last reference has the pairs of objects, if one of their searches was not refused.
  for (VoxelRow& row : rows)
    if (has_reference && row.answer.n_pairs > 0)
      row.false_positive_rate =
          1 - static_cast<double>(reference.n_pairs) / static_cast<double>(row.answer.n_pairs);
  std::ranges::stable_sort(rows, [](const VoxelRow& a, const VoxelRow& b) {
    return a.objects != b.objects ? a.objects < b.objects : a.factor < b.factor;
  });
  return rows;
}

bool agrees(const std::vector<VoxelRow>& rows) {
  return std::ranges::all_of(rows,
                             [](const VoxelRow& row) { return row.agrees || !row.note.empty(); });
}

const kit::Rows<VoxelRow>& voxel_report() {
  static const kit::Rows<VoxelRow> rows(columns);
  return rows;
}

std::vector<std::string> voxel_files() {
  std::vector<std::string> files{"_study.csv"};
  for (const Picture& picture : pictures) files.emplace_back(picture.file);
  return files;
}

void draw_voxels(const std::string& prefix, const std::vector<VoxelRow>& rows) {
  kit::write_file(prefix + "_study.csv", voxel_report().csv(rows));
  for (const Picture& picture : pictures) {
    kit::Chart chart{.title = picture.title,
                     .x_label = picture.x_label,
                     .y_label = picture.y_label,
                     .x_log = true,
                     .y_log = picture.y_log};
    for (const VoxelRow& row : rows)
      kit::add_point(chart, row.objects, picture.x(row), picture.y(row));
    for (kit::Series& series : chart.series) series.style = picture.style;
    if (!chart.series.empty()) (void)kit::write_svg(prefix + picture.file, chart);
  }
}

}  // namespace collide_scene
