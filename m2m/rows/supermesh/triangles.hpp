// Integrals over what a source and a target triangle have in common. They need not lie in one plane:
// the source triangle is projected along the normal of the target triangle and clipped in its plane.
//
//         source  ╱ ╲ ╱ ╲           Corners of the source have the weights of their feet in the target
//             ┆  ╱┆  ╳   ╲          triangle, and heights above its plane. Neighbours in the source
//             ┆   ┆ ┆ ┆             share feet, bit for bit, so they cover a target triangle without a
//         ────●───●─●─●─── target   gap and without an overlap, however curved both walls are.
//
// So what a wall covers of another one, and which of it more than once, is known up to rounding as in
// tetrahedra, and constants are kept. (In a common plane between both, which a pair has for itself,
// it would be known up to the error of the gap only.) The areas are those of the target.
//
// What is farther than the tolerance from the plane has nothing in common with the target, nor has a
// source triangle whose normal is turned by more than 60 degrees, as Facing counts.
#pragma once

#include "m2m/rows/supermesh/moments.hpp"
#include "m2m/transfer_kind.hpp"

#include <utility>
#include <vector>

namespace tess::m2m {

struct TrianglePlane {
  Corners corners{};
  double area = 0;   ///< exactly 0 if there is none
  double scale = 0;  ///< the inverse of the greatest coordinate of an edge from corner 0
  Point normal{};    ///< of the length 1; 0 without an area
  std::array<Point, 2> slopes{};  ///< of the weights of the corners 1 and 2, for lengths × scale
  double snap = 0;                ///< snap_reach()

  TrianglePlane() = default;
  explicit TrianglePlane(const Corners& c);
};

/// Stands for PairCutter between triangles.
class TriangleCutter {
 public:
  explicit TriangleCutter(double tolerance, Facing facing = Facing::either)
      : tolerance_(tolerance), facing_(facing) {}

  /// Takes a pair, unless it clearly has no area in common.
  void add(const TrianglePlane& source, const TrianglePlane& target, std::int32_t number);
  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  /// Calls found(number, moments) for the pairs that have an area in common, and forgets all. The
  /// moments are those of PairCutter: the volume is an area, and the fourth row and column are 0.
  template <class Found>
  void cut(const Found& found) {
    for (const auto& [number, moments] : pairs_)
      if (moments.volume > 0) found(number, moments);
    pairs_.clear();
  }

 private:
  double tolerance_;
  Facing facing_;
  std::vector<std::pair<std::int32_t, PairMoments>> pairs_;
};

}  // namespace tess::m2m
