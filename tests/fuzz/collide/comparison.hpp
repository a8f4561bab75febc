// The scene of a seed is searched, and the answers are compared with those of brute force.
#pragma once

#include "collide/pairs.hpp"
#include "tests/fuzz/collide/look.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace collide_fuzz {

using PairList = std::vector<tess::collide::Pair>;

struct Comparison {
  std::string failure;           ///< of the first answer that differs; empty if there is none
  std::uint64_t n_pairs = 0;     ///< that were compared
  std::uint64_t n_compared = 0;  ///< answers
  std::uint64_t n_refused = 0;   ///< searches with voxels that are too small

  /// Notes whether `found` is `expected`, in any order.
  void pairs(PairList found, PairList expected, std::string_view what);
  /// Notes whether another answer is that of brute force.
  void answer(bool agrees, std::string_view what);
};

/// The serial face: pairs of one set by every method, with models, and of two sets; shapes of
/// different kinds; within a radius, nearest, and along a ray.
void compare_serial(const Look& look, Comparison& out);

/// The chares on a simulated machine with random message order and migration: two collisions,
/// between which the objects move.
void compare_chares(const Look& look, std::int32_t n_pes, Comparison& out);

}  // namespace collide_fuzz
