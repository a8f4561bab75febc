#include "apps/particles/study/study.hpp"

#include <filesystem>

namespace particles {
namespace {

using R = const StudyRow&;
using kit::Json, kit::of;

template <auto member>
Json word(R row) {
  return (row.*member).empty() ? Json() : Json(row.*member);
}

constexpr kit::Column<StudyRow> columns[] = {
    {"part", "study", "<6", of<&StudyRow::part>},
    {"resolution", "n", "5", of<&StudyRow::resolution>},
    {"method", "method", "<9", of<&StudyRow::method>},
    {"stored", "stored", "<10", word<&StudyRow::stored>},
    {"look_up", "look-up", "<9", word<&StudyRow::look_up>},
    {"rule", "rule", "<30", word<&StudyRow::rule>},
    {"step", "step", "9.3g", of<&StudyRow::step>},
    {"build_seconds", "build s", "9.3f", of<&StudyRow::build_seconds>},
    {"build_cpu_seconds", "CPU s", "9.3f", of<&StudyRow::build_cpu_seconds>},
    {"bytes", "bytes", "9.0f", of<&StudyRow::bytes>},
    {"distance_error", "distance", "9.2e", of<&StudyRow::distance_error>},
    {"order", "order", "9.2f", of<&StudyRow::order>},
    {"distance_error_max", "max", "9.2e", of<&StudyRow::distance_error_max>},
    {"normal_error_degrees", "normal", "9.3f", of<&StudyRow::normal_error>},
    {"penetration", "depth", "9.2e", of<&StudyRow::penetration>},
    {"place_error", "place", "9.2e", of<&StudyRow::place_error>},
    {"angle_error_degrees", "angle", "9.3f", of<&StudyRow::angle_error>},
    {"lost", "lost", "9.0f", of<&StudyRow::lost>},
    {"bounces", "of", "9.0f", of<&StudyRow::bounces>},
    {"ns", "ns", "9.3f", of<&StudyRow::ns>},
    {"cpu_ns", "CPU ns", "9.3f", of<&StudyRow::cpu_ns>},
    {"of_tree", "of tree", "9.4f", of<&StudyRow::relative>},
    {"note", "", "<", of<&StudyRow::note>}};

/// A picture of the rows of a part: a point per row, a line per choice.
struct Picture {
  const char *file, *title, *part, *x_label, *y_label;
  Json (*x)(R);
  Json (*y)(R);
  bool x_log = true;
};
constexpr const char* of_angle = "RMS error of the angle, degrees";
constexpr Picture pictures[] = {
    {"study_distance.svg", "distance", "field", "voxels along an axis", "RMS error of the distance",
     of<&StudyRow::resolution>, of<&StudyRow::distance_error>},
    {"study_bounce.svg", "bounces", "field", "CPU ns per particle and step", of_angle,
     of<&StudyRow::cpu_ns>, of<&StudyRow::angle_error>, false},
    {"study_build.svg", "construction", "field", "CPU seconds", of_angle,
     of<&StudyRow::build_cpu_seconds>, of<&StudyRow::angle_error>},
    {"study_memory.svg", "memory", "field", "bytes of the field", of_angle, of<&StudyRow::bytes>,
     of<&StudyRow::angle_error>},
    {"study_step.svg", "rules", "rule", "speed x dt / thickness", "RMS error of the place",
     of<&StudyRow::step>, of<&StudyRow::place_error>}};

std::string choice(R row) {
  if (row.part == "rule") return row.rule;
  return row.method + (row.stored == "flat" ? ", " : ", compressed, ") + row.look_up;
}

void draw(const std::string& folder, const Picture& picture, const std::vector<StudyRow>& rows) {
  kit::Chart chart{.title = picture.title,
                   .x_label = picture.x_label,
                   .y_label = picture.y_label,
                   .x_log = picture.x_log,
                   .y_log = true};
  for (const StudyRow& row : rows)
    if (row.part == picture.part)
      kit::add_point(chart, choice(row), picture.x(row), picture.y(row));
  if (!chart.series.empty())
    (void)kit::write_svg((std::filesystem::path(folder) / picture.file).string(), chart);
}

}  // namespace

const kit::Rows<StudyRow>& study_report() {
  static const kit::Rows<StudyRow> rows(columns);
  return rows;
}

std::string study_table(const std::vector<StudyRow>& rows) {
  return study_report().table(rows) +
         "lengths in the object's units, angles in degrees, RMS except for max and depth; step: "
         "speed x dt as a part of\nthe thickness; ns per particle and step: wall clock, and CPU "
         "time of the thread; the least of five measurements\n";
}

std::vector<std::string> study_pictures() {
  std::vector<std::string> files;
  for (const Picture& picture : pictures) files.emplace_back(picture.file);
  return files;
}

void draw_study(const std::string& folder, const std::vector<StudyRow>& rows) {
  for (const Picture& picture : pictures) draw(folder, picture, rows);
}

}  // namespace particles
