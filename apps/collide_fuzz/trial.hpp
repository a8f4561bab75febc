// The trials of a seed: its scene is searched, and the pairs are compared with those of brute
// force.
#pragma once

#include "apps/collide_fuzz/look.hpp"

#include <cstdint>
#include <string>

namespace collide_fuzz {

/// What a trial did.
struct Outcome {
  std::string failure;           ///< empty if all answers agree with brute force
  std::uint64_t n_pairs = 0;     ///< that were compared
  std::uint64_t n_compared = 0;  ///< answers
  std::uint64_t n_refused = 0;   ///< searches with voxels that are too small
};

/// The serial face: pairs of one set by every method, with models, and of two sets; shapes of
/// different kinds; within a radius, nearest, and along a ray.
[[nodiscard]] Outcome try_serial(const Look& look);

/// The chares on a simulated machine with random message order and migration: two collisions,
/// between which the objects move.
[[nodiscard]] Outcome try_chares(const Look& look, std::int32_t n_pes);

}  // namespace collide_fuzz
