#include "apps/collide_scene/scenes/scene.hpp"

#include "apps/collide_scene/scenes/kinds.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

namespace collide_scene {
namespace {

using tess::collide::Aabb;

constexpr std::uint64_t kMost = 1u << 28;

template <Scene (*make)(std::uint64_t)>
Scene without_seed(std::uint64_t n, std::uint64_t) {
  return make(n);
}

constexpr SceneKind kinds[] = {
    {"wave", "N triangles of a wavy plane, one model", 1u << 20, without_seed<wave>},
    {"planes", "N triangles, half in each of two near-parallel wavy planes", 1u << 20,
     without_seed<two_planes>},
    {"crossing", "N triangles, half in each of two wavy planes that cross at a right angle",
     1u << 20, without_seed<crossing_planes>},
    {"dragon", "about N triangles of a closed, knotted, bumpy tube, one model", 871'414,
     without_seed<dragon>},
    {"boxes", "N random boxes of one scale in the unit cube, 3.5 pairs per box", 1'000'000,
     random_boxes},
    {"disparity", "N cubes with sizes over four decades, 9.5 pairs per cube", 1'000'000,
     four_decades},
    {"disparity6", "N cubes with sizes over six decades, 9.5 pairs per cube", 1'000'000,
     six_decades},
    {"lshapes", "N nested L shapes of four triangles: all boxes overlap, no two shapes touch", 1000,
     without_seed<nested_ls>},
    {"segments", "N crossing thin triangles, N * N / 4 pairs", 2000,
     without_seed<crossing_segments>},
    {"needles", "N long thin triangles, 35 pairs of boxes and .02 pairs per triangle", 100'000,
     needles},
    {"long_needles", "N thin triangles twice as long, 250 pairs of boxes per triangle", 100'000,
     long_needles},
    {"short_triangles", "N random triangles of one scale", 100'000, short_triangles},
    {"crowd", "about N triangles of many closed moving models in clusters of uneven density",
     1u << 20, crowd},
};

}  // namespace

std::vector<Aabb> boxes_of(const Scene& scene) {
  std::vector<Aabb> boxes;
  fill_boxes(scene, boxes);
  return boxes;
}
void fill_boxes(const Scene& scene, std::vector<Aabb>& boxes) {
  boxes.reserve(scene.n_objects());
  boxes.assign(scene.boxes.begin(), scene.boxes.end());
  for (const auto& triangle : scene.triangles) boxes.push_back(box_of(triangle));
}

std::span<const SceneKind> scene_kinds() {
  return kinds;
}

const SceneKind* find_scene_kind(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  for (const SceneKind& kind : kinds)
    if (kind.name == name) return &kind;
  return nullptr;
}

Scene make_scene(std::string_view text, std::uint64_t seed) {
  const SceneKind* kind = find_scene_kind(text);
  if (kind == nullptr) {
    std::string names;
    for (const SceneKind& each : kinds) names.append(names.empty() ? "" : ", ").append(each.name);
    tess::fail(tess::ErrorCode::bad_value, "no scene '", text, "': there are ", names,
               ", each alone or with a number (boxes:1000)");
  }
  std::uint64_t n = kind->default_n;
  if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
    const std::string_view digits = text.substr(colon + 1);
    n = tess::parse_number<std::uint64_t>(digits).value_or(0);
    if (n < 1 || n > kMost)
      tess::fail(tess::ErrorCode::bad_value, "scene '", text, "': '", digits,
                 "' is no number from 1 to ", kMost);
  }
  return kind->make(n, seed);
}

}  // namespace collide_scene
