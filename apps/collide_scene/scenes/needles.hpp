// Triangles in random directions at random places of the unit cube. Their sizes shrink with
// N^(-1/3), so that a triangle has as many pairs whatever N is; those that follow are of 100 000.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene {

/// A tenth long, and a ten-thousandth wide: 3.5 million pairs of boxes overlap, and 1 800 pairs of
/// triangles meet.
[[nodiscard]] Scene needles(std::uint64_t n, std::uint64_t seed);
/// Two tenths long.
[[nodiscard]] Scene long_needles(std::uint64_t n, std::uint64_t seed);
/// Two edges of a fiftieth: 160 000 pairs of boxes.
[[nodiscard]] Scene short_triangles(std::uint64_t n, std::uint64_t seed);

}  // namespace collide_scene
