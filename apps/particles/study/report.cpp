#include "apps/particles/study/study.hpp"
#include "apps/plot/chart.hpp"
#include "apps/plot/quoting.hpp"
#include "apps/plot/write_file.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <map>

namespace particles {
namespace {

std::string cell(double value, const char* format) {
  return value < 0 ? "-" : fmt::format(fmt::runtime(format), value);
}
std::string cell(std::int64_t value) {
  return value < 0 ? "-" : fmt::format("{}", value);
}

const StudyRow* coarser(const std::vector<StudyRow>& rows, const StudyRow& row) {
  const StudyRow* found = nullptr;
  for (const StudyRow& other : rows)
    if (other.part == row.part && other.method == row.method && other.stored == row.stored &&
        other.look_up == row.look_up && other.resolution < row.resolution &&
        (found == nullptr || other.resolution > found->resolution))
      found = &other;
  return found;
}

/// By which power of the cell the distance error fell since the next coarser row.
std::string order(const std::vector<StudyRow>& rows, const StudyRow& row) {
  const StudyRow* from = coarser(rows, row);
  if (from == nullptr || !(from->distance_error > 0) || !(row.distance_error > 0)) return "-";
  const double finer = (row.resolution - 1.0) / (from->resolution - 1.0);
  return fmt::format("{:.2f}",
                     std::log(from->distance_error / row.distance_error) / std::log(finer));
}

void draw(const std::string& path, plot::Chart chart, const std::vector<StudyRow>& rows,
          const char* part, std::string (*name)(const StudyRow&),
          plot::Point (*point)(const StudyRow&)) {
  std::map<std::string, std::size_t> known;
  for (const StudyRow& row : rows) {
    if (row.part != part || !row.note.empty()) continue;
    const plot::Point at_row = point(row);
    if (at_row.x < 0 || at_row.y < 0) continue;  // not measured in this row
    const auto [at, is_new] = known.try_emplace(name(row), chart.series.size());
    if (is_new) chart.series.push_back({.name = name(row)});
    chart.series[at->second].points.push_back(at_row);
  }
  if (!chart.series.empty()) (void)plot::write_svg(path, chart);
}

}  // namespace

std::string study_table(const std::vector<StudyRow>& rows) {
  std::string out = fmt::format(
      "{:<6} {:>5} {:<9} {:<10} {:<9} {:<29} {:>5} {:>8} {:>8} {:>9} {:>6} {:>9} {:>7} {:>9} {:>9} "
      "{:>7} "
      "{:>9} {:>8} {:>8}\n",
      "study", "n", "method", "stored", "look-up", "rule", "step", "build s", "MB", "distance",
      "order", "max", "normal", "depth", "place", "angle", "lost", "ns", "of tree");
  for (const StudyRow& row : rows) {
    if (!row.note.empty()) {
      out += fmt::format("{:<6} {:>5} {:<9} refused: {}\n", row.part, row.resolution, row.method,
                         row.note);
      continue;
    }
    const std::string lost = row.lost < 0 ? "-" : fmt::format("{}/{}", row.lost, row.bounces);
    out += fmt::format(
        "{:<6} {:>5} {:<9} {:<10} {:<9} {:<29} {:>5} {:>8} {:>8} {:>9} {:>6} {:>9} {:>7} {:>9} "
        "{:>9} "
        "{:>7} {:>9} {:>8} {:>8}\n",
        row.part, row.resolution, row.method, row.stored.empty() ? "-" : row.stored,
        row.look_up.empty() ? "-" : row.look_up, row.rule, cell(row.step, "{:.3g}"),
        cell(row.build_seconds, "{:.3f}"),
        row.bytes == 0 ? "-" : fmt::format("{:.3f}", static_cast<double>(row.bytes) / 1e6),
        cell(row.distance_error, "{:.2e}"), row.part == "field" ? order(rows, row) : "-",
        cell(row.distance_error_max, "{:.2e}"), cell(row.normal_error, "{:.3f}"),
        cell(row.penetration, "{:.2e}"), cell(row.place_error, "{:.2e}"),
        cell(row.angle_error, "{:.3f}"), lost, cell(row.ns, "{:.3f}"),
        cell(row.relative, "{:.4f}"));
  }
  out +=
      "lengths in the object's units, angles in degrees, RMS but for max and depth; step: speed x "
      "dt as "
      "a part of\nthe thickness; ns a particle and step, fastest of three\n";
  return out;
}

std::string study_csv(const std::vector<StudyRow>& rows) {
  std::string out =
      "part,resolution,method,stored,look_up,rule,step,build_seconds,bytes,distance_error,"
      "distance_error_max,normal_error_degrees,penetration,place_error,angle_error_degrees,lost,"
      "bounces,ns,of_tree,note\n";
  const auto number = [](double value) {
    return value < 0 ? std::string() : fmt::format("{}", value);
  };
  for (const StudyRow& row : rows)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.part,
                       row.resolution, row.method, row.stored, row.look_up,
                       plot::csv_field(row.rule), number(row.step), number(row.build_seconds),
                       row.bytes, number(row.distance_error), number(row.distance_error_max),
                       number(row.normal_error), number(row.penetration), number(row.place_error),
                       number(row.angle_error), row.lost < 0 ? "" : cell(row.lost),
                       row.bounces < 0 ? "" : cell(row.bounces), number(row.ns),
                       number(row.relative), plot::csv_field(row.note));
  return out;
}

void write_study(const std::string& folder, const std::vector<StudyRow>& rows) {
  const auto in = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
  plot::write_file(in("study.csv"), study_csv(rows));
  const auto draw_fields = [&](const char* name, plot::Chart chart,
                               plot::Point (*point)(const StudyRow&)) {
    chart.y_log = true;
    draw(
        in(name), std::move(chart), rows, "field",
        [](const StudyRow& row) {
          return row.method + ", " + (row.stored == "flat" ? "" : row.stored + ", ") + row.look_up;
        },
        point);
  };
  const std::string of_angle = "RMS error of the angle, degrees";
  draw_fields("study_distance.svg",
              {.title = "distance",
               .x_label = "voxels an axis",
               .y_label = "RMS error of the distance",
               .x_log = true},
              [](const StudyRow& row) {
                return plot::Point{1.0 * row.resolution, row.distance_error};
              });
  draw_fields("study_bounce.svg",
              {.title = "bounces", .x_label = "ns a particle and step", .y_label = of_angle},
              [](const StudyRow& row) {
                return plot::Point{row.ns, row.angle_error};
              });
  draw_fields("study_build.svg",
              {.title = "construction", .x_label = "seconds", .y_label = of_angle, .x_log = true},
              [](const StudyRow& row) {
                return plot::Point{row.build_seconds, row.angle_error};
              });
  draw_fields("study_memory.svg",
              {.title = "memory", .x_label = "MB", .y_label = of_angle, .x_log = true},
              [](const StudyRow& row) {
                return plot::Point{1e-6 * static_cast<double>(row.bytes), row.angle_error};
              });
  draw(
      in("study_step.svg"),
      {.title = "rules",
       .x_label = "speed x dt / thickness",
       .y_label = "RMS error of the place",
       .x_log = true,
       .y_log = true},
      rows, "rule", [](const StudyRow& row) { return row.rule; },
      [](const StudyRow& row) {
        return plot::Point{row.step, row.place_error};
      });
}

}  // namespace particles
