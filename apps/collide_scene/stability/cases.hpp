// The stability report: extreme scenes of boxes and of triangles, collided by the serial face and
// by brute force. The program prints it (--stability), a test asserts it.
#pragma once

#include "apps/collide_scene/run/result.hpp"
#include "apps/kit/progress.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace collide_scene {

struct StabilityRow {
  std::string name;
  std::string parameter;  ///< the quantity that is varied, as "offset"; may be empty
  double value = 0;       ///< of the parameter
  std::size_t n_objects = 0;
  std::uint64_t n_pairs = 0;              ///< by brute force
  std::uint64_t lost = 0;                 ///< pairs that the library did not find
  std::uint64_t doubled = 0;              ///< found more than once
  std::uint64_t added = 0;                ///< found, but no pairs
  double seconds = 0, brute_seconds = 0;  ///< CPU time
  std::string note{};                     ///< why the library refused the scene
  /// None lost, doubled or added, and no slower than 20 times brute force and 20 ms beside.
  bool ok = false;
};

/// The three ways in which `found` differs from `expected`, which is sorted and has each pair once.
struct Difference {
  std::uint64_t lost = 0, doubled = 0, added = 0;

  friend bool operator==(const Difference&, const Difference&) = default;
};
[[nodiscard]] Difference difference(const std::vector<ScenePair>& expected,
                                    std::vector<ScenePair> found);

/// Takes some seconds. `progress` may be null.
[[nodiscard]] std::vector<StabilityRow> stability_report(kit::Progress* progress = nullptr);

}  // namespace collide_scene
