// In which order the parts of a mesh are asked for the vertex nearest to a point: by the distance
// of their boxes. Asked so, with the best distance found so far, hardly more than the parts are
// asked that the point is near to. Travels with the Worker that asks.
#pragma once

#include "m2m/search/nearest_vertex.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tess::m2m {

class NearestParts {
 public:
  /// A part and the distance of its box from some point.
  struct Part {
    double squared_distance = -1;
    std::int32_t number = -1;
    friend auto operator<=>(const Part&, const Part&) = default;
  };
  static constexpr Part none{std::numeric_limits<double>::infinity(),
                             std::numeric_limits<std::int32_t>::max()};

  NearestParts() = default;
  /// `boxes`: of all parts, lo > hi for a part without vertices. `questions`: a box around all
  /// points that will be asked about.
  NearestParts(std::span<const Aabb> boxes, const Aabb& questions);

  /// The part that comes after `last` in the order of (distance of box, number), or `none`. Begin
  /// with Part{}.
  [[nodiscard]] Part next(const Point& p, const Part& last) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(boxes_, numbers_);
  }

 private:
  std::vector<Aabb> boxes_;  // of parts that may hold a nearest vertex of any question
  std::vector<std::int32_t> numbers_;
};

}  // namespace tess::m2m
