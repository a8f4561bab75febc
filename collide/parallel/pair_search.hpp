// Finds the pairs of a voxel. Usually they are few and found at once. A voxel with very many, for
// instance of n identical boxes, is searched in portions, so that n * n pairs never stand in
// memory:
//
//     pairs within S       too many?  within S1, within S2, and of S1 with S2
//     pairs of S with T    too many?  of S1 with T, and of S2 with T
//
// The pairs of a search that found too many are dropped and found again, at most about once each.
#pragma once

#include "collide/parallel/hit_sorter.hpp"
#include "collide/parallel/part.hpp"
#include "collide/parallel/voxel_problem.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tess::collide {

/// The pairs of a portion. Each takes 8 bytes per owner.
inline constexpr std::size_t most_pairs = std::size_t{1} << 18;

/// Finds the pairs of a voxel and sends them to the owners. Returns false, and sends nothing, if
/// they are more than most_pairs.
[[nodiscard]] bool search_at_once(std::span<const Part> parts);

class PortionSearch {
 public:
  explicit PortionSearch(std::vector<Part> parts);

  /// Returns the next portion, or one without hits at the end.
  [[nodiscard]] HitSorter next();
  [[nodiscard]] const auto& call() const { return parts_.front().delivery().receivers.call; }

 private:
  void divide(const PairSets& sets);

  const std::vector<Part> parts_;
  VoxelProblem objects_;
  std::vector<PairSets> remaining_;
};

}  // namespace tess::collide
