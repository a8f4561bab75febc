// Error against run time: what each choice (resolution, construction, look-up, rule, step) costs,
// and how far it is from exact collision with the triangles. Serial; on one object at rest, in its
// own coordinates.
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/kit/rows.hpp"
#include "apps/particles/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace particles {

/// What was measured. It may be negative: an order where the error grew, the cost of collision
/// where its difference of two times is noise.
using Measurement = std::optional<double>;

/// One choice. Lengths are in the object's units. Times are the least of several measurements (see
/// least_cost()).
struct StudyRow {
  std::string part;                           ///< field, rule, cost
  int resolution = 0;                         ///< voxels along an axis
  std::string method, stored, look_up, rule;  ///< stored: flat, compressed; empty: no field
  Measurement step;                           ///< speed × dt as a part of the thickness
  Measurement build_seconds, build_cpu_seconds;
  Measurement bytes;
  Measurement distance_error;      ///< RMS, against the closest point of the triangles
  Measurement order;               ///< the power of the cell with which distance_error fell
  Measurement distance_error_max;  ///< of the same points
  Measurement normal_error;        ///< RMS, in degrees
  Measurement penetration;         ///< greatest depth below the triangles
  Measurement place_error;         ///< RMS distance of bounces from where they should be
  Measurement angle_error;         ///< RMS, in degrees, of the velocity after the bounce
  Measurement lost;                ///< particles that went in, or on as if there were no object
  Measurement bounces;             ///< out of so many
  Measurement ns, cpu_ns;          ///< per particle and step
  Measurement relative;            ///< cost of collision as a part of that by a tree of boxes
  std::string note;                ///< why a choice is refused; else empty
};

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

[[nodiscard]] const kit::Rows<StudyRow>& study_report();
[[nodiscard]] std::string study_table(const std::vector<StudyRow>& rows);

/// Writes pictures to a folder, each with its data as CSV.
void draw_study(const std::string& folder, const std::vector<StudyRow>& rows);
/// Their names in the folder.
[[nodiscard]] std::vector<std::string> study_pictures();

}  // namespace particles
