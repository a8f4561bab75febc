#include "apps/kit/chart.hpp"
#include "apps/particles/study/study.hpp"

#include <array>
#include <filesystem>
#include <fmt/core.h>
#include <map>

namespace particles {
namespace {

constexpr std::array columns{
    StudyColumn{"step", "step", "{:.3g}", &StudyRow::step},
    StudyColumn{"build_seconds", "build s", "{:.3f}", &StudyRow::build_seconds},
    StudyColumn{"build_cpu_seconds", "CPU s", "{:.3f}", &StudyRow::build_cpu_seconds},
    StudyColumn{"bytes", "bytes", "{}", &StudyRow::bytes},
    StudyColumn{"distance_error", "distance", "{:.2e}", &StudyRow::distance_error},
    StudyColumn{"order", "order", "{:.2f}", &StudyRow::order},
    StudyColumn{"distance_error_max", "max", "{:.2e}", &StudyRow::distance_error_max},
    StudyColumn{"normal_error_degrees", "normal", "{:.3f}", &StudyRow::normal_error},
    StudyColumn{"penetration", "depth", "{:.2e}", &StudyRow::penetration},
    StudyColumn{"place_error", "place", "{:.2e}", &StudyRow::place_error},
    StudyColumn{"angle_error_degrees", "angle", "{:.3f}", &StudyRow::angle_error},
    StudyColumn{"lost", "lost", "{}", &StudyRow::lost},
    StudyColumn{"bounces", "of", "{}", &StudyRow::bounces},
    StudyColumn{"ns", "ns", "{:.3f}", &StudyRow::ns},
    StudyColumn{"cpu_ns", "CPU ns", "{:.3f}", &StudyRow::cpu_ns},
    StudyColumn{"of_tree", "of tree", "{:.4f}", &StudyRow::relative}};

/// A picture of the rows of a part: a point per row, a line per choice.
struct Picture {
  const char *file, *title, *part, *x_label, *y_label;
  double StudyRow::*x;
  double StudyRow::*y;
  bool x_log = true;
};
constexpr const char* of_angle = "RMS error of the angle, degrees";
constexpr std::array pictures{
    Picture{"study_distance.svg", "distance", "field", "voxels along an axis",
            "RMS error of the distance", &StudyRow::resolution, &StudyRow::distance_error},
    Picture{"study_bounce.svg", "bounces", "field", "CPU ns per particle and step", of_angle,
            &StudyRow::cpu_ns, &StudyRow::angle_error, false},
    Picture{"study_build.svg", "construction", "field", "CPU seconds", of_angle,
            &StudyRow::build_cpu_seconds, &StudyRow::angle_error},
    Picture{"study_memory.svg", "memory", "field", "bytes of the field", of_angle, &StudyRow::bytes,
            &StudyRow::angle_error},
    Picture{"study_step.svg", "rules", "rule", "speed x dt / thickness", "RMS error of the place",
            &StudyRow::step, &StudyRow::place_error}};

std::string choice(const StudyRow& row) {
  if (row.part == "rule") return row.rule;
  return row.method + (row.stored == "flat" ? ", " : ", compressed, ") + row.look_up;
}

void draw(const std::string& folder, const Picture& picture, const std::vector<StudyRow>& rows) {
  kit::Chart chart{.title = picture.title,
                   .x_label = picture.x_label,
                   .y_label = picture.y_label,
                   .x_log = picture.x_log,
                   .y_log = true};
  std::map<std::string, std::size_t> known;
  for (const StudyRow& row : rows) {
    const double x = row.*picture.x, y = row.*picture.y;
    if (row.part != picture.part || x < 0 || y < 0) continue;
    const auto [at, is_new] = known.try_emplace(choice(row), chart.series.size());
    if (is_new) chart.series.push_back({.name = at->first});
    chart.series[at->second].points.push_back({x, y});
  }
  if (!chart.series.empty())
    (void)kit::write_svg((std::filesystem::path(folder) / picture.file).string(), chart);
}

constexpr const char* words = "{:<6} {:>5} {:<9} {:<10} {:<9} {:<30}";

}  // namespace

std::span<const StudyColumn> study_columns() {
  return columns;
}

std::string study_table(const std::vector<StudyRow>& rows) {
  std::string out =
      fmt::format(fmt::runtime(words), "study", "n", "method", "stored", "look-up", "rule");
  for (const StudyColumn& column : columns) out += fmt::format(" {:>9}", column.title);
  out += '\n';
  for (const StudyRow& row : rows) {
    if (!row.note.empty()) {
      out += fmt::format("{:<6} {:>5} {:<9} refused: {}\n", row.part, row.resolution, row.method,
                         row.note);
      continue;
    }
    const auto or_dash = [](const std::string& text) { return text.empty() ? "-" : text; };
    out += fmt::format(fmt::runtime(words), row.part, row.resolution, row.method,
                       or_dash(row.stored), or_dash(row.look_up), row.rule);
    for (const StudyColumn& column : columns) {
      const double value = row.*column.value;
      out += fmt::format(
          " {:>9}", value == not_measured ? "-" : fmt::format(fmt::runtime(column.format), value));
    }
    out += '\n';
  }
  return out +
         "lengths in the object's units, angles in degrees, RMS except for max and depth; step: "
         "speed x dt as a part of\nthe thickness; ns per particle and step: wall clock, and CPU "
         "time of the thread; the least of five measurements\n";
}

std::vector<std::string> study_pictures() {
  std::vector<std::string> files;
  for (const Picture& picture : pictures) files.emplace_back(picture.file);
  return files;
}

void write_study(const std::string& folder, const std::vector<StudyRow>& rows) {
  for (const Picture& picture : pictures) draw(folder, picture, rows);
}

}  // namespace particles
