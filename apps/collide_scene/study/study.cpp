#include "apps/collide_scene/study/study.hpp"

#include "apps/collide_scene/run/serial.hpp"
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
void measure(const Scene& scene, const Rules& rules, StudyRow& row) {
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

}  // namespace

std::vector<StudyRow> study(const Scene& scene, const Options& options, kit::Progress& progress) {
  constexpr std::array factors{1.0, 0.125, 0.25, 0.5, 2.0, 4.0, 8.0, 16.0};
  const std::uint32_t n_kinds = scene.triangles.empty() ? 1 : 2;
  std::vector<StudyRow> rows;
  Answer reference;  // of the objects, that of the first row that is not refused
  bool has_reference = false;
  for (std::uint32_t kind = 0; kind < n_kinds; ++kind) {
    const std::size_t chosen = rows.size();
    has_reference = false;
    for (const double factor : factors) {
      progress.part(rows.size() + 1, n_kinds * factors.size());
      progress.phase("study: voxel sizes");
      StudyRow row;
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
  for (StudyRow& row : rows)
    if (has_reference && row.answer.n_pairs > 0)
      row.false_positive_rate =
          1 - static_cast<double>(reference.n_pairs) / static_cast<double>(row.answer.n_pairs);
  std::ranges::stable_sort(rows, [](const StudyRow& a, const StudyRow& b) {
    return a.objects != b.objects ? a.objects < b.objects : a.factor < b.factor;
  });
  return rows;
}

bool agrees(const std::vector<StudyRow>& rows) {
  return std::ranges::all_of(rows,
                             [](const StudyRow& row) { return row.agrees || !row.note.empty(); });
}

}  // namespace collide_scene
