// The nearest vertices of the points of a target piece, of all source pieces, and the rows of
// moving least squares that follow from them.
#pragma once

#include "m2m/couple/search_step.hpp"
#include "m2m/rows/reconstruct/moving_least_squares.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tess::m2m {

class PointFits {
 public:
  PointFits() = default;
  PointFits(std::int32_t order, std::size_t n_points)
      : order_(order), n_found_(n_points, 0), found_(n_points * n_wanted()) {}

  /// How many vertices each point needs.
  [[nodiscard]] std::size_t n_wanted() const { return MovingLeastSquares::n_neighbours(order_); }
  /// A vertex that a source piece has found for a point; a second one of the same id does not
  /// count. Returns the square of the distance beyond which no vertex is of interest.
  double add(std::uint32_t point, const NearestVertex::Neighbour& vertex, const Point& at,
             collide::OwnerId source);
  /// When all are there, for the points of the target with their rows (numbers among `points`):
  /// statuses, distances and rows go to `found`. Returns what source pieces shall send.
  [[nodiscard]] Addressed<std::vector<VertexId>> finish(std::span<const Point> points,
                                                        TargetFound& found) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(order_, n_found_, found_);
  }

 private:
  /// A vertex of a source piece.
  struct Found {
    NearestVertex::Neighbour vertex{};
    Point at{};
    collide::OwnerId source{};
  };

  std::int32_t order_ = 1;
  std::vector<std::uint32_t> n_found_;  // per point
  std::vector<Found> found_;            // n_wanted() per point; the found ones first, ascending
};

}  // namespace tess::m2m
