// The kinds of scenes, made by rule; scene.cpp lists them with their names.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene {

// Tessellated planes with small harmonics, the paper's scene (Lawlor and Kalé 2002, section 4.2):
// unit quads at whole numbers, two triangles each, z = 4 sin(2πx/32) cos(2πy/32). N triangles are
// the first N of the rows; a row has the largest power of two of quads that is at most √(N/2).

/// One plane, one model: neighbours touch each other.
[[nodiscard]] Scene wave(std::uint64_t n);

/// Two of them, half the triangles each; the second, model 1, is shifted by (0.3, 0.3, 0.2).
[[nodiscard]] Scene two_planes(std::uint64_t n);

/// The second plane stands upright on the middle row of the first, also shifted by (0.3, 0.3, 0.2).
[[nodiscard]] Scene crossing_planes(std::uint64_t n);

/// A closed curved surface of many small triangles without a file, in the place of the scanned
/// dragon of the paper: a bumpy tube around a trefoil knot, about 6 units across, one model,
/// without self-intersection. It has at most n triangles, as many as whole rings of a closed tube have, but
/// at least 24; each edge is in two of them.
[[nodiscard]] Scene dragon(std::uint64_t n);

// Boxes, and triangles in random directions, at random places of the unit cube. Their sizes shrink
// with N^(-1/3), so that an object has as many pairs whatever N is. They have no models.

/// Places uniform within the unit cube, extents uniform up to 0.019 at a million boxes: about 3.45
/// million pairs there.
[[nodiscard]] Scene random_boxes(std::uint64_t n, std::uint64_t seed);

/// Cubes with edges log-uniform over four decades; 9.5 million pairs at a million cubes.
[[nodiscard]] Scene four_decades(std::uint64_t n, std::uint64_t seed);
/// Makes cubes with edges log-uniform over six decades.
[[nodiscard]] Scene six_decades(std::uint64_t n, std::uint64_t seed);

/// Triangles a tenth long and a ten-thousandth wide, at 100 000 as the next two: 3.5 million pairs
/// of boxes overlap, and 1 800 pairs of triangles meet.
[[nodiscard]] Scene needles(std::uint64_t n, std::uint64_t seed);
/// Two tenths long.
[[nodiscard]] Scene long_needles(std::uint64_t n, std::uint64_t seed);
/// Two edges of a fiftieth: 160 000 pairs of boxes.
[[nodiscard]] Scene short_triangles(std::uint64_t n, std::uint64_t seed);

// The two scenes in which any method that knows only boxes, or any method at all, takes n² steps
// (section 1.3).
//
//     \ \ \   / / /     nested L shapes: each box contains      ──┼─┼─┼──   crossing segments: as
//      \ \ \ / / /      most of the others, and no two          ──┼─┼─┼──   many hits as half of
//       \ \ v / /       shapes touch                            ──┼─┼─┼──   them times the rest

/// n L shapes, nested, standing on their corners, in planes that are not parallel to an axis. Each
/// is a model of four triangles. The boxes of any two of the 4 n triangles overlap, closed; no
/// triangles of different models touch.
[[nodiscard]] Scene nested_ls(std::uint64_t n);

/// n thin triangles, ⌈n/2⌉ along x and the others along y, each its own model. Each along x crosses
/// each along y, and no other two meet: ⌈n/2⌉ ⌊n/2⌋ pairs, of the triangles and of their boxes.
[[nodiscard]] Scene crossing_segments(std::uint64_t n);

/// A crowd of at least one body and about n triangles; each body is a model. It moves.
[[nodiscard]] Scene crowd(std::uint64_t n, std::uint64_t seed);

}  // namespace collide_scene
