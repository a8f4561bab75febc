// The scene as a picture: seen from above and aside, models in pale colours, what collides from
// yellow to dark red by its number of hits.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

#include <span>
#include <string>

namespace collide_scene {

/// An SVG. Only what is seen is in it: at most some ten thousand triangles as they are, more as
/// rows of pixels. n_hits: one per object.
[[nodiscard]] std::string picture(const Scene& scene, std::span<const std::uint32_t> n_hits);

}  // namespace collide_scene
