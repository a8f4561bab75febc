// Counts of a search.
#pragma once

#include "m2m/status.hpp"

#include <array>
#include <cstdint>

namespace tess::m2m {

struct Tally {
  std::array<std::uint64_t, 4> counts{};  ///< target points per Status
  /// Pairs (tetrahedron, point in its box) tested; of conservative kinds, pairs of tetrahedra that
  /// are cut, since no face clearly separates them.
  std::uint64_t n_candidates = 0;
  /// Source pieces that had not moved since the last search and kept what it had made of them.
  std::uint64_t n_kept_sources = 0;
  /// Counts, for conservative kinds, points or cells that the source covers more than once, since
  /// its tetrahedra overlap there. Their values are not the projection of one field.
  std::uint64_t n_overcovered = 0;
  double most_covered = 0;  ///< the greatest coverage among these, such as 1.25 times

  [[nodiscard]] std::uint64_t count(Status status) const {
    return counts[static_cast<std::size_t>(status)];
  }
  Tally& operator+=(const Tally& other) {
    for (std::size_t s = 0; s < counts.size(); ++s) counts[s] += other.counts[s];
    n_candidates += other.n_candidates;
    n_kept_sources += other.n_kept_sources;
    n_overcovered += other.n_overcovered;
    if (other.most_covered > most_covered) most_covered = other.most_covered;
    return *this;
  }
};

}  // namespace tess::m2m
