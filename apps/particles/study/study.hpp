// Error against run time: what each choice (resolution, construction, look-up, rule, step) costs,
// and how far it is from exact collision with the triangles. Serial; on one object at rest, in its
// own coordinates.
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/particles/scene/scene.hpp"

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace particles {

/// Of a value that was not measured in a row. Measured ones may be negative: an order where the
/// error grew, the cost of collision where its difference of two times is noise.
inline constexpr double not_measured = -HUGE_VAL;

/// One choice. Lengths are in the object's units. Times are the least of several measurements (see
/// least_cost()).
struct StudyRow {
  std::string part;                           ///< field, rule, cost
  double resolution = 0;                      ///< voxels along an axis
  std::string method, stored, look_up, rule;  ///< stored: flat, compressed; empty: no field
  double step = not_measured;                 ///< speed × dt as a part of the thickness
  double build_seconds = not_measured, build_cpu_seconds = not_measured;
  double bytes = not_measured;
  double distance_error = not_measured;  ///< RMS, against the closest point of the triangles
  double order = not_measured;           ///< the power of the cell with which distance_error fell
  double distance_error_max = not_measured;  ///< of the same points
  double normal_error = not_measured;        ///< RMS, in degrees
  double penetration = not_measured;         ///< greatest depth below the triangles
  double place_error = not_measured;         ///< RMS distance of bounces from where they should be
  double angle_error = not_measured;         ///< RMS, in degrees, of the velocity after the bounce
  double lost = not_measured;     ///< particles that went in, or on as if there were no object
  double bounces = not_measured;  ///< out of so many
  double ns = not_measured, cpu_ns = not_measured;  ///< per particle and step
  double relative = not_measured;  ///< cost of collision as a part of that by a tree of boxes
  std::string note;                ///< why a choice is refused
};

/// A number of a row, for the table and the files.
struct StudyColumn {
  const char* name;    ///< in JSON
  const char* title;   ///< in the table
  const char* format;  ///< in the table
  double StudyRow::*value;
};
[[nodiscard]] std::span<const StudyColumn> study_columns();

struct StudyOptions {
  std::vector<int> resolutions{16, 32, 64};
  std::size_t n_samples = 4000;  ///< points at which distance and normal are compared
  std::size_t n_bounces = 400;
  std::size_t n_timed = 100'000;      ///< particles that are timed
  kit::Progress* progress = nullptr;  ///< shows the part of the study; may be null
};

/// The study of the scene's first object: fields (resolution × construction × look-up, each with
/// swept impact; exact ones also compressed), rules (rule × step, at the object's resolution:
/// impact and spring against bounces off the triangles, drag and surface flow against steps of
/// 0.002), and cost beside a tree of boxes. The scene has an object.
[[nodiscard]] std::vector<StudyRow> study(const Scene& scene, const StudyOptions& options);

[[nodiscard]] std::string study_table(const std::vector<StudyRow>& rows);

/// Writes pictures to a folder, each with its data as CSV.
void write_study(const std::string& folder, const std::vector<StudyRow>& rows);
/// Their names in the folder.
[[nodiscard]] std::vector<std::string> study_pictures();

}  // namespace particles
