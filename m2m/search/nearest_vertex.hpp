// The vertex nearest to a point, by a k-d tree with the box of each node (Bentley 1975; boxes prune
// points far outside, where a grid would look at all its cells). For the policy `nearest`, and for
// one part of a source mesh as well: the nearest of several parts is the least (distance, global
// id). Built once, immutable after that.
#pragma once

#include "m2m/mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tess::m2m {

/// The squared distance of a point to a box; 0 within. Never more than squared_distance() to a
/// point of the box, in the same arithmetic.
[[nodiscard]] inline double squared_distance(const Point& p, const Aabb& box) {
  const auto gap = [&](std::size_t axis) {
    return std::max(std::max(box.lo[axis] - p[axis], p[axis] - box.hi[axis]), 0.0);
  };
  const double x = gap(0), y = gap(1), z = gap(2);
  return x * x + y * y + z * z;
}

[[nodiscard]] inline double squared_distance(const Point& p, const Point& q) {
  const double x = q[0] - p[0], y = q[1] - p[1], z = q[2] - p[2];
  return x * x + y * y + z * z;
}

class NearestVertex {
 public:
  struct Answer {
    std::int32_t vertex;      ///< index into the points; of several as near, the lowest
    double squared_distance;  ///< from coordinate differences
  };
  /// Takes a copy of the points. n log n.
  explicit NearestVertex(std::span<const Point> points);

  /// The vertex nearest to `p` among those not farther than `reach`; vertex -1 where there is none.
  [[nodiscard]] Answer find(const Point& p,
                            double squared_reach = std::numeric_limits<double>::infinity()) const;

 private:
  /// Some of the vertices, and the two nodes that they are divided among.
  struct Node {
    Aabb box;
    std::int32_t first, last;  // places in the tree's order
    std::int32_t second = -1;  // the second child; the first one follows its parent. -1: a leaf
  };
  void build(std::int32_t first, std::int32_t last);

  std::vector<Point> points_;           // in the tree's order
  std::vector<std::int32_t> vertices_;  // their indices
  std::vector<Node> nodes_;
};

}  // namespace tess::m2m
