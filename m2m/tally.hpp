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
  /// Counts, for transposed couplings, points that give forces to no vertex, since they have no
  /// donor: these forces are lost.
  std::uint64_t n_lost = 0;
  /// Counts, for moving least squares, points whose neighbours determine a polynomial of lower
  /// order only, or one of this order in fewer directions, such as those in a plane.
  std::uint64_t n_lower_order = 0, n_lower_dimension = 0;
  /// Counts, for kind native, points whose element folds over or does not reach them: they have the
  /// linear value of the tetrahedron.
  std::uint64_t n_linear = 0;

  [[nodiscard]] std::uint64_t count(Status status) const {
    return counts[static_cast<std::size_t>(status)];
  }
  Tally& operator+=(const Tally& other) {
    for (std::size_t s = 0; s < counts.size(); ++s) counts[s] += other.counts[s];
    n_candidates += other.n_candidates;
    n_kept_sources += other.n_kept_sources;
    n_overcovered += other.n_overcovered;
    n_lost += other.n_lost;
    n_lower_order += other.n_lower_order;
    n_lower_dimension += other.n_lower_dimension;
    n_linear += other.n_linear;
    if (other.most_covered > most_covered) most_covered = other.most_covered;
    return *this;
  }
};

}  // namespace tess::m2m
