// The study of voxels: sizes around the chosen one, and boxes against exact triangles. It reports
// what each costs, and which part of its pairs are no pairs of objects.
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"
#include "apps/kit/progress.hpp"
#include "apps/kit/rows.hpp"

#include <string>
#include <vector>

namespace collide_scene {

struct VoxelRow {
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
[[nodiscard]] std::vector<VoxelRow> study_voxels(const Scene& scene, const Options& options,
                                                 kit::Progress& progress);

/// True if no voxel size changed an answer.
[[nodiscard]] bool agrees(const std::vector<VoxelRow>& rows);

[[nodiscard]] const kit::Rows<VoxelRow>& voxel_report();
/// What follows PREFIX in the names of the files of draw_voxels(): a table and charts.
[[nodiscard]] std::vector<std::string> voxel_files();
/// Writes the table as CSV and the charts, each with its data beside it.
void draw_voxels(const std::string& prefix, const std::vector<VoxelRow>& rows);

}  // namespace collide_scene
