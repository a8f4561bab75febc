// The options of the command line. Every room may include this header; it includes none of them.
#pragma once

#include "collide/hit.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace collide_scene {

/// Which pairs count.
struct Rules {
  bool triangles = false;  ///< pairs of triangles that intersect; otherwise of their boxes
  tess::collide::WithinModel within_model = tess::collide::WithinModel::skip;
  bool open = false;      ///< objects that only touch are no pair
  double voxel_size = 0;  ///< 0: chosen by the library
  double slack = 0;       ///< on chares; 0: each step searches
};

struct Options {
  std::vector<std::string> inputs;  ///< files and names of scenes
  Rules rules{};
  std::string move;  ///< see Motion; empty: as the scene moves by itself
  std::int32_t steps = 1;
  std::int32_t repeat = 1;  ///< collisions per step; the time is that of the fastest
  std::uint64_t seed = 1;
  std::string json, out;
  bool serial = false;  ///< also where the runtime has several PEs
  bool explain = false;
  bool study = false;
};

}  // namespace collide_scene
