// What a run gives. Pairs are counted and hashed as pairs of positions in the scene, so that the
// answer does not depend on the order of pairs, on PEs, processes or voxels.
#pragma once

#include "collide/grid_counts.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sys/resource.h>
#include <vector>

namespace collide_scene {

/// Two objects by their positions in the scene, first < second.
struct ScenePair {
  std::uint32_t first = 0, second = 0;

  friend bool operator==(const ScenePair&, const ScenePair&) = default;
  friend auto operator<=>(const ScenePair&, const ScenePair&) = default;
};

/// A sum over pairs: the same in any order.
struct Answer {
  std::uint64_t n_pairs = 0;
  std::uint64_t n_candidates = 0;  ///< pairs of boxes that overlap
  std::uint64_t hash = 0;

  void add(ScenePair pair, int step) noexcept {
    ++n_pairs;
    const auto both = std::uint64_t{pair.first} << 32U | pair.second;
    hash += tess::mix(both ^ tess::mix(static_cast<std::uint64_t>(step)));
  }
  Answer& operator+=(const Answer& other) noexcept {
    n_pairs += other.n_pairs;
    n_candidates += other.n_candidates;
    hash += other.hash;
    return *this;
  }
  friend bool operator==(const Answer&, const Answer&) = default;
  /// Candidates may differ: long thin triangles are searched in pieces where the voxels are small.
  [[nodiscard]] bool has_pairs_of(const Answer& other) const noexcept {
    return n_pairs == other.n_pairs && hash == other.hash;
  }
};

/// What the library says about its grid; a number that one of its faces does not say is absent.
struct GridReport {
  tess::collide::GridCounts counts;
  std::optional<std::uint64_t> pieces;  ///< of triangles with capsules; 0: objects are boxes
  std::optional<std::uint64_t> bytes;   ///< of the grid and its scratch
};

struct StepResult {
  Answer answer;
  double seconds = 0;
  std::uint64_t n_kept = 0;  ///< pairs of larger boxes that were tested
  bool searched = true;      ///< if not, these pairs are of a step before
};

struct RunResult {
  std::vector<StepResult> steps;
  GridReport grid;                      ///< of the last step that searched
  std::vector<ScenePair> pairs;         ///< of the last step, sorted, if they were asked for
  std::uint64_t peak_memory_bytes = 0;  ///< sum over processes

  [[nodiscard]] Answer total() const {
    Answer sum;
    for (const StepResult& step : steps) sum += step.answer;
    return sum;
  }
  [[nodiscard]] std::size_t n_searched() const {
    return static_cast<std::size_t>(
        std::count_if(steps.begin(), steps.end(), [](const StepResult& s) { return s.searched; }));
  }
  [[nodiscard]] double seconds_per_step() const {
    double sum = 0;
    for (const StepResult& step : steps) sum += step.seconds;
    return steps.empty() ? 0 : sum / static_cast<double>(steps.size());
  }
};

/// The greatest resident size of this process so far.
[[nodiscard]] inline std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace collide_scene
