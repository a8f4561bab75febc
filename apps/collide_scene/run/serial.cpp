#include "apps/collide_scene/run/serial.hpp"

#include "collide/pairs.hpp"
#include "collide/triangle.hpp"
#include "runtime/core/cpu_clock.hpp"

#include <chrono>
#include <span>
#include <vector>

namespace collide_scene {
namespace {

/// A box per object, in memory that is kept: to get as much anew for each collision can take longer
/// than the search.
std::span<const tess::collide::Aabb> boxes_now(const Scene& scene) {
  if (scene.triangles.empty()) return scene.boxes;
  thread_local std::vector<tess::collide::Aabb> boxes;
  fill_boxes(scene, boxes);
  return boxes;
}

}  // namespace

SerialCollision collide_once(const Scene& scene, const Rules& rules, int step,
                             std::vector<ScenePair>* pairs) {
  using namespace tess::collide;
  SerialCollision out;
  PairStatistics statistics;
  PairOptions options;
  options.touching = rules.open ? Touching::does_not_count : Touching::counts;
  options.models = scene.models;
  options.within_model = scene.models.empty() ? WithinModel::test : rules.within_model;
  options.voxel_size = rules.voxel_size;
  options.statistics = &statistics;
  const auto found = [&](std::uint32_t i, std::uint32_t j) {
    out.answer.add({i, j}, step);
    if (pairs != nullptr) pairs->push_back({i, j});
  };
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_begin = tess::thread_cpu_seconds();
  if (rules.triangles)
    for_each_pair(std::span<const Triangle>(scene.triangles), options, found);
  else
    for_each_pair(boxes_now(scene), options, found);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  out.cpu_seconds = tess::thread_cpu_seconds() - cpu_begin;
  out.answer.n_candidates = statistics.n_candidates;
  out.grid.counts = statistics.grid;
  out.grid.bytes = statistics.bytes;
  return out;
}

}  // namespace collide_scene
