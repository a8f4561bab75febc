// Tessellated planes with small harmonics, the paper's scene (Lawlor and Kalé 2002, section 4.2):
// unit quads at whole numbers, two triangles each, z = 4 sin(2πx/32) cos(2πy/32). N triangles are
// the first N of the rows; a row has the largest power of two of quads that is at most √(N/2).
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene {

/// One plane, one model: neighbours touch each other.
[[nodiscard]] Scene wave(std::uint64_t n);

/// Two of them, half the triangles each; the second, model 1, is shifted by (0.3, 0.3, 0.2).
[[nodiscard]] Scene two_planes(std::uint64_t n);

/// The second plane stands upright on the middle row of the first, also shifted by (0.3, 0.3, 0.2).
[[nodiscard]] Scene crossing_planes(std::uint64_t n);

}  // namespace collide_scene
