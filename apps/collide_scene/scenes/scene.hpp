// A collision scene made by rule: objects, their model numbers, and a sentence. The same text gives
// the same scene, bit for bit, on every machine. Scenes need no runtime and no files.
//
//     make_scene("planes:65536")      65 536 triangles, half of them in each of two planes
//     make_scene("boxes")             the number of objects that the kind proposes
#pragma once

#include "collide/box.hpp"
#include "collide/triangle.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace collide_scene {

/// Objects are triangles or boxes: one of the two lists is empty.
struct Scene {
  std::string description;  ///< one line: what it is, and how many
  std::vector<tess::collide::Triangle> triangles;
  std::vector<tess::collide::Aabb> boxes;
  /// One number per object, in the order of the objects; the objects of a model are adjacent. Empty
  /// if pairs are not told apart by models.
  std::vector<std::uint32_t> models;
  /// Moves the objects of a scene of this kind to where they are at a step, which may be
  /// fractional; step 0 is how the scene was made. Empty if the scene does not move.
  std::function<void(double step, Scene& scene)> move;

  [[nodiscard]] std::size_t n_objects() const noexcept { return triangles.size() + boxes.size(); }
};

/// A box per object: those of the triangles, or the boxes themselves.
[[nodiscard]] std::vector<tess::collide::Aabb> boxes_of(const Scene& scene);
/// The same, in place of what `boxes` held.
void fill_boxes(const Scene& scene, std::vector<tess::collide::Aabb>& boxes);

/// A rule for scenes of any size.
struct SceneKind {
  std::string_view name;
  std::string_view meaning;  ///< of its number, too
  std::uint64_t default_n;
  Scene (*make)(std::uint64_t n, std::uint64_t seed);
};
[[nodiscard]] std::span<const SceneKind> scene_kinds();

/// The kind that NAME or NAME:N names; null if there is none, so that a text may name a file.
[[nodiscard]] const SceneKind* find_scene_kind(std::string_view text);

/// The scene that NAME or NAME:N names. Only kinds with random places depend on the seed. Throws
/// tess::Error for another name, and for an N outside 1 … 2^28.
[[nodiscard]] Scene make_scene(std::string_view text, std::uint64_t seed = 1);

}  // namespace collide_scene
