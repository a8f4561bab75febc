// The order in which the parts of a mesh are searched for the vertex nearest to a point: by the
// distance of their boxes. The search ends when the next box is farther than the best vertex found,
// so few parts are searched per point. A Worker holds this list and migrates with it.
#pragma once

#include "m2m/rows/search/nearest_vertex.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tess::m2m {

class NearestParts {
 public:
  /// A part, and the distance of its box from a given point.
  struct RankedPart {
    double squared_distance = -1;
    std::int32_t number = -1;
    friend auto operator<=>(const RankedPart&, const RankedPart&) = default;
  };
  static constexpr RankedPart none{std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<std::int32_t>::max()};

  NearestParts() = default;
  /// `boxes`: of all parts; lo > hi for a part without vertices. `queries`: a box around all points
  /// of later calls of next().
  NearestParts(std::span<const Aabb> boxes, const Aabb& queries);

  /// The part that follows `last` in the order of (distance of box, number), or `none` at the end.
  /// The first call takes RankedPart{}.
  [[nodiscard]] RankedPart next(const Point& p, const RankedPart& last) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(boxes_, numbers_);
  }

 private:
  std::vector<Aabb> boxes_;  // of the parts that may hold the nearest vertex of some query
  std::vector<std::int32_t> numbers_;
};

}  // namespace tess::m2m
