#include "apps/collide_scene/study/study.hpp"
#include "apps/kit/chart.hpp"
#include "apps/kit/quoting.hpp"
#include "apps/kit/write_file.hpp"

#include <array>
#include <fmt/format.h>

namespace collide_scene {
namespace {

template <class T>
std::string or_else(const std::optional<T>& value, const char* unknown) {
  return value ? fmt::format("{}", *value) : unknown;
}

double voxel_size(const StudyRow& row) {
  return row.voxel_size;
}
double ns_per_object(const StudyRow& row) {
  return row.ns_per_object;
}
double entries(const StudyRow& row) {
  return static_cast<double>(row.grid.counts.n_entries);
}
double false_percent(const StudyRow& row) {
  return 100 * row.false_positive_rate;
}

struct Picture {
  const char *file, *title, *x_label, *y_label;
  double (*x)(const StudyRow&);
  double (*y)(const StudyRow&);
  bool x_log, y_log;
  kit::Style style;
};
constexpr std::array pictures{
    Picture{"_study_time.svg", "time", "voxel size", "CPU ns per object", voxel_size, ns_per_object,
            true, true, kit::Style::lines_points},
    Picture{"_study_entries.svg", "objects in voxels", "voxel size", "(object, voxel)", voxel_size,
            entries, true, true, kit::Style::lines_points},
    Picture{"_study_error.svg", "error against run time, a point per voxel size",
            "CPU ns per object", "pairs that are none, %", ns_per_object, false_percent, true,
            false, kit::Style::points}};

}  // namespace

std::string study_table(const std::vector<StudyRow>& rows) {
  std::string out = fmt::format(
      "study\n  {:<10} {:>7} {:>11} {:>7} {:>10} {:>11} {:>12} {:>12} {:>8} {:>12} {:>10}\n",
      "objects", "factor", "voxel size", "levels", "voxels", "entries", "candidates", "pairs",
      "false %", "bytes", "CPU ns");
  for (const StudyRow& row : rows) {
    if (!row.note.empty()) {
      out += fmt::format("  {:<10} {:>7} {:>11.4g} refused: {}\n", row.objects, row.factor,
                         row.voxel_size, row.note);
      continue;
    }
    out += fmt::format(
        "  {:<10} {:>7} {:>11.4g} {:>7} {:>10} {:>11} {:>12} {:>12} {:>8.2f} {:>12} {:>10.2f}{}\n",
        row.objects, row.factor, row.voxel_size, row.grid.counts.n_levels, row.grid.counts.n_voxels,
        row.grid.counts.n_entries, row.answer.n_candidates, row.answer.n_pairs,
        100 * row.false_positive_rate, or_else(row.grid.bytes, "-"), row.ns_per_object,
        row.agrees ? "" : "  OTHER PAIRS");
  }
  return out +
         "  factor: of the voxel size that the library chooses; false: pairs of boxes that are no "
         "pairs of objects; CPU time per object, the least of three\n";
}

std::string study_csv(const std::vector<StudyRow>& rows) {
  std::string out =
      "objects,factor,voxel_size,levels,voxels,entries,left_out,candidates,pairs,"
      "false_positive_rate,bytes,cpu_seconds,cpu_ns_per_object,agrees,note\n";
  for (const StudyRow& row : rows) {
    const tess::collide::GridCounts& grid = row.grid.counts;
    const auto count = [&row](std::uint64_t n) {  // none if the voxel size was refused
      return row.note.empty() ? fmt::format("{}", n) : std::string();
    };
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.objects, row.factor,
                       row.voxel_size, count(grid.n_levels), count(grid.n_voxels),
                       count(grid.n_entries), count(grid.n_left_out), row.answer.n_candidates,
                       row.answer.n_pairs, row.false_positive_rate, or_else(row.grid.bytes, ""),
                       row.cpu_seconds, row.ns_per_object, row.agrees ? 1 : 0,
                       kit::csv_field(row.note));
  }
  return out;
}

void write_study(const std::string& prefix, const std::vector<StudyRow>& rows) {
  kit::write_file(prefix + "_study.csv", study_csv(rows));
  for (const Picture& picture : pictures) {
    kit::Chart chart{.title = picture.title,
                     .x_label = picture.x_label,
                     .y_label = picture.y_label,
                     .x_log = picture.x_log,
                     .y_log = picture.y_log};
    for (const char* objects : {"boxes", "triangles"}) {
      kit::Series series{.name = objects, .style = picture.style};
      for (const StudyRow& row : rows)
        if (row.objects == objects && row.note.empty() && (!picture.y_log || picture.y(row) > 0))
          series.points.push_back({picture.x(row), picture.y(row)});
      if (!series.points.empty()) chart.series.push_back(std::move(series));
    }
    if (!chart.series.empty()) (void)kit::write_svg(prefix + picture.file, chart);
  }
}

}  // namespace collide_scene
