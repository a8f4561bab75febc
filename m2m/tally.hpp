// Counts of a search.
#pragma once

#include "m2m/status.hpp"

#include <array>
#include <cstdint>

namespace tess::m2m {

/// The number of target points per Status, of pairs (tetrahedron, point in its box) tested, and of
/// source pieces that had not moved since the last search and kept what it had made of them.
struct Tally {
  std::array<std::uint64_t, 4> counts{};
  std::uint64_t n_candidates = 0;
  std::uint64_t n_kept_sources = 0;

  [[nodiscard]] std::uint64_t count(Status status) const {
    return counts[static_cast<std::size_t>(status)];
  }
  Tally& operator+=(const Tally& other) {
    for (std::size_t s = 0; s < counts.size(); ++s) counts[s] += other.counts[s];
    n_candidates += other.n_candidates;
    n_kept_sources += other.n_kept_sources;
    return *this;
  }
};

}  // namespace tess::m2m
