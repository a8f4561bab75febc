// The stability report: extreme scenes of boxes and of triangles, collided by the serial face and
// by brute force. The program prints it (--stability), a test asserts it.
#pragma once

#include "apps/collide_scene/run/result.hpp"
#include "apps/kit/cases.hpp"
#include "apps/kit/progress.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace collide_scene {

/// `met`: the CPU time of the search against brute force; a millisecond beside counts for nothing.
struct StabilityCase : kit::Case {
  std::size_t n_objects = 0;
  std::uint64_t n_pairs = 0;              ///< by brute force
  std::uint64_t lost = 0;                 ///< pairs that the library did not find
  std::uint64_t doubled = 0;              ///< found more than once
  std::uint64_t added = 0;                ///< found, but no pairs
  double seconds = 0, brute_seconds = 0;  ///< CPU time
};

/// The three ways in which `found` differs from `expected`, which is sorted and has each pair once.
struct Difference {
  std::uint64_t lost = 0, doubled = 0, added = 0;

  friend bool operator==(const Difference&, const Difference&) = default;
};
[[nodiscard]] Difference difference(const std::vector<ScenePair>& expected,
                                    std::vector<ScenePair> found);

/// Takes some seconds. `progress` may be null.
[[nodiscard]] std::vector<StabilityCase> stability_cases(kit::Progress* progress = nullptr);
/// Prints and writes them; returns the exit code.
int report_stability(kit::Driver& driver);

}  // namespace collide_scene
