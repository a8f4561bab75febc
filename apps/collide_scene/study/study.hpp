// The study of a scene: voxel sizes around the chosen one, and boxes against exact triangles. What
// each costs, and which part of its pairs are none of the objects.
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"
#include "apps/kit/progress.hpp"

#include <string>
#include <vector>

namespace collide_scene {

struct StudyRow {
  std::string objects;  ///< boxes, triangles (tested exactly)
  double factor = 1;    ///< of the voxel size that the library chooses
  double voxel_size = 0;
  GridReport grid{};
  double cpu_seconds = 0;  ///< the least of three
  double ns_per_object = 0;
  Answer answer{};
  double false_positive_rate = 0;  ///< part of the pairs that are no pairs of objects
  bool agrees = true;              ///< the same pairs as the first row that is not refused
  std::string note{};              ///< why the library refused this voxel size; then no numbers
};

/// Serial runs of the scene as it is, under the rules of the options except their voxel size.
[[nodiscard]] std::vector<StudyRow> study(const Scene& scene, const Options& options,
                                          kit::Progress& progress);

/// True if no voxel size changed an answer.
[[nodiscard]] bool agrees(const std::vector<StudyRow>& rows);

[[nodiscard]] std::string study_table(const std::vector<StudyRow>& rows);
[[nodiscard]] std::string study_csv(const std::vector<StudyRow>& rows);

/// PREFIX_study.csv and the charts PREFIX_study_time.svg, …_entries.svg, …_error.svg, each with its
/// data beside it.
void write_study(const std::string& prefix, const std::vector<StudyRow>& rows);

}  // namespace collide_scene
