// What the steps of a search cost, in nanoseconds on the machine that they were measured on
// (bench_collide). The voxel size and the method within a voxel follow from them; no answer does.
#pragma once

#include <cstddef>

namespace tess::collide::search::costs {

inline constexpr double per_entry = 20;  ///< an object in a voxel: sorted, gathered
inline constexpr double per_probe = 4;   ///< a box that is compared with others
inline constexpr double per_vector = 3;  ///< a comparison of a box with a vector of boxes
inline constexpr double per_cell = 1.2;  ///< a cell, also an empty one
/// So many objects are compared without a look for a better way.
inline constexpr std::size_t few_objects = 512;
/// A sweep pays from here on.
inline constexpr std::size_t sweep_from = 96;
/// A voxel that is a chare: its messages and look-ups.
inline constexpr double per_chare = 1750;
inline constexpr double per_grid = 3000;  ///< a grid: its choice and its memory

// Objects with capsules (choose_pieces.hpp).
inline constexpr double per_pair = 8;      ///< a pair of boxes: found, passed on
inline constexpr double per_test = 50;     ///< an exact test of two triangles
inline constexpr double per_capsule = 50;  ///< an object: its capsule
inline constexpr double per_capsules = 6;  ///< a comparison of two capsules
inline constexpr double per_piece = 100;   ///< a piece of an object: its box, sorted and compared
inline constexpr double per_overlap = 2;   ///< two pieces that the choice compares

}  // namespace tess::collide::search::costs
