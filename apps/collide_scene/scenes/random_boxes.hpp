// Boxes at random places of the unit cube. Their sizes shrink with N^(-1/3), so that a box has as
// many pairs whatever N is. Boxes have no models.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene {

/// Places uniform within the unit cube, extents uniform up to 0.019 at a million boxes: about 3.45
/// million pairs there.
[[nodiscard]] Scene random_boxes(std::uint64_t n, std::uint64_t seed);

/// Cubes with edges log-uniform over four decades; 9.5 million pairs at a million cubes.
[[nodiscard]] Scene four_decades(std::uint64_t n, std::uint64_t seed);
/// The same over six decades.
[[nodiscard]] Scene six_decades(std::uint64_t n, std::uint64_t seed);

}  // namespace collide_scene
