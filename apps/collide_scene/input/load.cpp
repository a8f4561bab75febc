#include "apps/collide_scene/input/load.hpp"

#include "collide/read_surface.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace collide_scene {
namespace {

Scene read_file(const std::string& path) {
  const tess::dn::Surface surface = tess::dn::read_surface(path);
  Scene scene;
  scene.triangles.reserve(surface.triangles.size());
  const auto point = [](const tess::dn::Vec3& p) { return tess::collide::Point{p.x, p.y, p.z}; };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    scene.triangles.push_back({{point(a), point(b), point(c)}});
  }
  scene.models.assign(scene.triangles.size(), 0);
  scene.description = fmt::format("{}: {} triangles", path, scene.triangles.size());
  if (!surface.remarks.empty())
    scene.description.append(" (").append(remarks_text(surface)).append(")");
  return scene;
}

Scene load_one(const std::string& input, std::uint64_t seed) {
  if (find_scene_kind(input) != nullptr) return make_scene(input, seed);
  if (tess::dn::names_surface(input)) return read_file(input);
  std::string names;
  for (const SceneKind& kind : scene_kinds()) names.append(" ").append(kind.name);
  tess::fail(tess::ErrorCode::bad_argument, input,
             ": is neither a file .obj, .ply or .stl nor a scene NAME:N; there are", names,
             tess::did_you_mean(input.substr(0, input.find(':')), names));
}

}  // namespace

Scene load(std::span<const std::string> inputs, std::uint64_t seed) {
  if (inputs.size() == 1) return load_one(inputs.front(), seed);
  Scene all;
  std::uint32_t next_model = 0;
  for (const std::string& input : inputs) {
    Scene scene = load_one(input, seed);
    const bool mixes = (!scene.boxes.empty() && !all.triangles.empty()) ||
                       (!scene.triangles.empty() && !all.boxes.empty());
    if (mixes)
      tess::fail(tess::ErrorCode::bad_argument, input, ": its objects are ",
                 scene.boxes.empty() ? "triangles" : "boxes", ", those of ", inputs.front(), " ",
                 scene.boxes.empty() ? "boxes" : "triangles",
                 "; give scenes of one kind of object");
    if (scene.n_objects() > std::numeric_limits<std::uint32_t>::max() - all.n_objects())
      tess::fail(tess::ErrorCode::bad_argument, input, ": with it there are ",
                 all.n_objects() + scene.n_objects(), " objects; a scene has at most 2^32 - 1");
    all.triangles.insert(all.triangles.end(), scene.triangles.begin(), scene.triangles.end());
    all.boxes.insert(all.boxes.end(), scene.boxes.begin(), scene.boxes.end());
    if (scene.models.empty()) scene.models.assign(scene.n_objects(), 0);
    for (const std::uint32_t model : scene.models) all.models.push_back(next_model + model);
    next_model += n_models(scene);
    all.description.append(all.description.empty() ? "" : "; ").append(scene.description);
  }
  return all;
}

std::uint32_t n_models(const Scene& scene) {
  return scene.models.empty() ? 0 : 1 + *std::ranges::max_element(scene.models);
}

std::string scenes_help() {
  std::string out = "Scenes (INPUT):\n";
  for (const SceneKind& kind : scene_kinds())
    out += fmt::format("  {:<24}{}\n", fmt::format("{}:N", kind.name), kind.meaning);
  return out;
}

}  // namespace collide_scene
