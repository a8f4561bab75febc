// Clusters of small boxes that drift through space, turn, and pass through each other. The space is
// a problem's plane of cells, one layer deep. The place of an object is a function of its number
// and the iteration: owners and oracle compute it in the same way.
//
//     ┌──────────────┐   Clusters have one size; the n-th has n² times the objects of the first,
//     │ ∴ →    ⁖     │   and n⁴ times its pairs. Objects are numbered cluster by cluster.
//     │     ⁘ ↙  ← ⁙ │
//     └──────────────┘
#pragma once

#include "apps/lb_lab/workload/workload.hpp"
#include "collide/hit.hpp"

#include <cstdint>
#include <vector>

namespace lb_lab {

class Clusters {
 public:
  explicit Clusters(const Problem& problem);

  [[nodiscard]] std::uint64_t n_objects() const { return n_objects_; }
  /// Nominal, at speed 1, per pair: the cost of objects is distributed over their pairs.
  [[nodiscard]] double seconds_a_pair() const { return seconds_a_pair_; }

  /// Objects first … last − 1 of an owner in an iteration; the local id is the number.
  [[nodiscard]] std::vector<tess::collide::Item> items(std::uint64_t first, std::uint64_t last,
                                                       tess::collide::OwnerId owner,
                                                       std::int32_t iteration) const;

 private:
  /// A cluster in an iteration.
  struct Pose {
    double x = 0, y = 0, cosine = 1, sine = 0;
  };
  [[nodiscard]] Pose pose(std::uint64_t cluster, std::int32_t iteration) const;
  [[nodiscard]] std::uint64_t first_of(std::uint64_t cluster) const;

  double width_, height_, n_iterations_;
  std::uint64_t seed_, n_objects_;
  double seconds_a_pair_;
  double radius_, edge_;  // of a cluster, of a box
};

/// A pair is two different boxes with closures that meet.
inline constexpr tess::collide::PairRules pair_rules{tess::collide::Touching::counts,
                                                     tess::collide::WithinModel::test};

/// A pair's part of the answer, in an iteration. It does not depend on the order of the two.
[[nodiscard]] std::uint64_t answer_of_pair(tess::collide::LocalId a, tess::collide::LocalId b,
                                           std::int32_t iteration);

}  // namespace lb_lab
