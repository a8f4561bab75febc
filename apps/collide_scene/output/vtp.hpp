// Results for ParaView, as the text of VTP files with raw binary data behind it.
#pragma once

#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"

#include <span>
#include <string>

namespace collide_scene {

/// The triangles (of boxes: their faces, as quadrilaterals) with the number of hits of the object,
/// its model and its position in the scene. n_hits: one per object.
[[nodiscard]] std::string hits_vtp(const Scene& scene, std::span<const std::uint32_t> n_hits);

/// A segment per pair, between the centres of the boxes of the two, with the positions of both.
[[nodiscard]] std::string pairs_vtp(const Scene& scene, std::span<const ScenePair> pairs);

}  // namespace collide_scene
