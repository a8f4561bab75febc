// The extreme scenes of the stability report. Random ones are the same in every run.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene::stability {

/// Some pairs per object, on both sides of zero; coordinates up to about one. No models.
[[nodiscard]] Scene random_boxes_around_zero(std::size_t n);
[[nodiscard]] Scene random_triangles(std::size_t n);

/// Every coordinate is multiplied by `scale`, then moved by `offset`.
[[nodiscard]] Scene changed(Scene scene, double scale, double offset);
/// The objects take turns: models 0, 1 … n - 1, 0, 1 ….
[[nodiscard]] Scene in_models(Scene scene, std::uint32_t n);
[[nodiscard]] Scene without_models(Scene scene);
[[nodiscard]] Scene each_twice(Scene scene);
/// One more object, `times` as large as the scene.
[[nodiscard]] Scene with_one_over_all(Scene scene, double times);

/// n^3 boxes [0.1 i, 0.1 i + 0.15]: the corners lie on and beside the faces of many grids.
[[nodiscard]] Scene lattice(int n);
/// n^3 unit cubes that fill a cube; they touch only.
[[nodiscard]] Scene face_to_face(int n);
[[nodiscard]] Scene identical_boxes(std::size_t n);
[[nodiscard]] Scene identical_triangles(std::size_t n);
/// Boxes with corners on a coarse lattice, without extent along n_flat or more axes.
[[nodiscard]] Scene flat_boxes(std::size_t n, int n_flat);
/// Sizes log-uniform over so many decades, up to a third of the scene.
[[nodiscard]] Scene mixed_boxes(std::size_t n, double decades);
[[nodiscard]] Scene mixed_triangles(std::size_t n, double decades);
/// As long as a sixth of the scene, and `aspect` times thinner; boxes along the axes.
[[nodiscard]] Scene needle_boxes(std::size_t n, double aspect);
[[nodiscard]] Scene needle_triangles(std::size_t n, double aspect);
/// In the plane z = slope (x + 2 y), as far as doubles allow.
[[nodiscard]] Scene in_one_plane(std::size_t n, double slope);
[[nodiscard]] Scene degenerate_triangles(std::size_t n);

}  // namespace collide_scene::stability
