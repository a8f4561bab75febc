// What a random scene looks like, drawn from a seed: how many objects, of which shape, where, how
// large, and under which rules they are searched. The same seed gives the same scene, bit for bit.
#pragma once

#include "collide/hit.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace collide_fuzz {

enum class Shape {
  box,
  box_of_float,
  box_in_2d,
  box_of_float_in_4d,
  triangle,
  triangle_of_float,
  sphere,
  tetrahedron,
  segment,
  swept_box,
};
inline constexpr std::array<const char*, 10> shape_names{"boxes",
                                                         "boxes of float",
                                                         "boxes in 2 dimensions",
                                                         "boxes of float in 4 dimensions",
                                                         "triangles",
                                                         "triangles of float",
                                                         "balls",
                                                         "tetrahedra",
                                                         "segments",
                                                         "moving boxes"};

/// Where the objects are, in the unit cube.
enum class Place { anywhere, lattice, plane, line, clusters, one_point };
inline constexpr std::array<const char*, 6> place_names{
    "anywhere", "on a lattice", "in a plane", "on a line", "in clusters", "in one point"};

struct Look {
  std::uint64_t seed = 0;
  Shape shape{};
  Place place{};
  std::uint32_t n = 0;
  double offset = 0, scale = 1;  ///< of all coordinates: offset + scale * x
  double largest = 1;            ///< extent of an object, of the width of the scene
  double decades = 0;            ///< extents are log-uniform over so many
  double no_extent = 0;          ///< chance that an object has no extent on an axis
  double repeated = 0;           ///< chance that an object equals an earlier one
  double degenerate = 0;         ///< chance of a needle, or of corners that coincide
  bool has_large_one = false;    ///< an object over all others
  std::uint32_t n_models = 1;
  tess::collide::WithinModel within_model{};
  tess::collide::Touching touching{};
  double voxel_size = 0;  ///< 0: chosen
  /// On chares: part of the clients submit the capsules of objects that have some.
  double with_capsules = 0;
  double piece_length = 0;
  double slack = 0;  ///< if there is one, no client submits capsules
};

/// The Look of a seed.
[[nodiscard]] Look look_of(std::uint64_t seed);

/// One line, for a failure.
[[nodiscard]] std::string describe(const Look& look);

}  // namespace collide_fuzz
