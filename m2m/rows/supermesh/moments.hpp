// Integrals over the intersection K of a source and a target tetrahedron. The intersections of all
// pairs are the supermesh of both meshes (Farrell and Maddison 2011, "Conservative interpolation
// between volume meshes by local Galerkin projection", section 3). Both meshes are piecewise linear
// there, so integrals over the supermesh are exact but for rounding.
//
// The tetrahedron with the smaller volume is carried and the other one cuts, because coordinates
// relative to the larger one are small. Signs of heights are exact (orientation.hpp): neighbours
// that share a face cut without a gap and without an overlap.
#pragma once

#include "m2m/rows/supermesh/polyhedron.hpp"
#include "m2m/rows/supermesh/tet_planes.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tess::m2m {

using Matrix4 = std::array<std::array<double, 4>, 4>;

struct PairMoments {
  double volume = 0;  ///< of K; 0 if the tetrahedra only touch
  Matrix4 mixed{};    ///< mixed[a][b]: integral over K of source weight a times target weight b
};

/// Cuts many pairs of tetrahedra whose boxes overlap: all by a face, then those left by the next one,
/// since a processor works on several pairs at a time, but waits for the cuts of a single one. The
/// moments of a pair are the same in every batch.
class PairCutter {
 public:
  /// Takes a pair, unless a face clearly separates it: then it has no volume in common, as most pairs
  /// whose boxes overlap. That takes a few nanoseconds. The planes must stay until cut().
  void add(const TetPlanes& source, const TetPlanes& target, std::int32_t number) {
    if (n_ == pairs_.size()) pairs_.resize(2 * n_ + 64);
    const bool carries_target = std::abs(target.sixfold) <= std::abs(source.sixfold);
    const TetPlanes &carried = carries_target ? target : source,
                    &cutting = carries_target ? source : target;
    const Heights above = heights(cutting, carried);
    const bool apart = is_apart(above, sure_height(cutting, carried)) |
                       is_apart(heights(carried, cutting), sure_height(carried, cutting));
    Pair& pair = pairs_[n_];
    pair.carried = &carried;
    pair.cutting = &cutting;
    // As a whole they would be copied from memory by wider vectors than those just written there.
    for (std::size_t f = 0; f < 4; ++f) pair.heights[f] = above[f];
    pair.number = number;
    pair.carries_target = carries_target;
    n_ += apart ? 0U : 1U;  // without a branch: it would not be predictable
  }
  [[nodiscard]] std::size_t size() const { return n_; }

  /// Calls found(number, moments) for the pairs that have a volume in common, and forgets all.
  /// Rows and columns of moments add up: the sum of mixed[a][b] is the volume. None of them is
  /// negative. A tetrahedron without volume intersects nothing.
  template <class Found>
  void cut(const Found& found) {
    cut_all();
    for (const std::uint32_t k : left_) {
      const PairMoments moments = moments_of(k);
      if (moments.volume > 0) found(pairs_[k].number, moments);
    }
    n_ = 0;
  }

 private:
  struct Pair {
    const TetPlanes* carried;  // the smaller one
    const TetPlanes* cutting;
    Heights heights;  // of the carried one
    std::int32_t number;
    bool carries_target;
  };
  [[nodiscard]] static bool is_plain(const Pair& pair);
  void cut_all();
  template <std::size_t face>
  void cut_by();
  [[nodiscard]] PairMoments moments_of(std::uint32_t k);

  std::vector<Pair> pairs_;  // the first n_ of them
  std::size_t n_ = 0;
  std::vector<Polyhedron> overlaps_;  // per pair
  std::vector<std::uint32_t> left_;   // those with a volume in common
};

/// The moments of any two tetrahedra.
[[nodiscard]] PairMoments pair_moments(const Corners& source, const Corners& target);
[[nodiscard]] double overlap_volume(const Corners& a, const Corners& b);

}  // namespace tess::m2m
