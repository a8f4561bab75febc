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

/// The study of PEs.
struct Ladder {
  std::vector<std::int32_t> pes{1, 4, 16, 64};
  bool is_weak = false;  ///< the number of each scene is that of one PE
  std::vector<std::string> balance{"none"};
  /// Nanoseconds of an item, in the order of tess::collide::SimulatedCosts.
  std::vector<double> costs{9.12, 13.14, 0.22, 0, 12.17, 42.68};
  /// The simulated machines, as for --sim.
  std::string network = "cost=580ns,latency=2us,bandwidth=4.2GB/s,per-process=1";
};

struct Options {
  std::vector<std::string> inputs{};  ///< files and names of scenes
  Rules rules{};
  std::string move{};  ///< see Motion; empty: as the scene moves by itself
  std::int32_t steps = 1;
  std::int32_t repeat = 1;  ///< collisions per step; the time is that of the fastest
  std::uint64_t seed = 1;
  std::string out{};
  bool serial = false;  ///< also where the runtime has several PEs
  Ladder ladder{};
};

}  // namespace collide_scene
