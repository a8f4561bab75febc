// The two scenes in which any method that knows only boxes, or any method at all, takes n² steps
// (Lawlor and Kalé 2002, section 1.3).
//
//     \ \ \   / / /     nested L shapes: each box contains      ──┼─┼─┼──   crossing segments: as
//      \ \ \ / / /      most of the others, and no two          ──┼─┼─┼──   many hits as half of
//       \ \ v / /       shapes touch                            ──┼─┼─┼──   them times the rest
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene {

/// n L shapes, nested, standing on their corners, in planes that are not parallel to an axis. Each
/// is a model of four triangles. The boxes of any two of the 4 n triangles overlap, closed; no
/// triangles of different models touch.
[[nodiscard]] Scene nested_ls(std::uint64_t n);

/// n thin triangles, ⌈n/2⌉ along x and the others along y, each its own model. Each along x crosses
/// each along y, and no other two meet: ⌈n/2⌉ ⌊n/2⌋ pairs, of the triangles and of their boxes.
[[nodiscard]] Scene crossing_segments(std::uint64_t n);

}  // namespace collide_scene
