// Finds the vertex nearest to a point, with a k-d tree that stores the box of each node (Bentley
// 1975). The boxes also prune the search for points far outside, for which a grid would visit all
// its cells. The tree serves the policy `nearest`. Each part of a source mesh has one; over several
// parts the nearest vertex is the minimum of (distance, global id). The tree does not change after
// it is built.
#pragma once

#include "m2m/mesh.hpp"
#include "runtime/core/algorithm.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tess::m2m {

/// The squared distance of a point from a box; 0 inside. It never exceeds the squared_distance() to
/// a point of the box, also after rounding.
[[nodiscard]] inline double squared_distance(const Point& p, const Aabb& box) {
  const auto gap = [&](std::size_t axis) {
    return std::max(std::max(box.lo[axis] - p[axis], p[axis] - box.hi[axis]), 0.0);
  };
  const double x = gap(0), y = gap(1), z = gap(2);
  return x * x + y * y + z * z;
}

[[nodiscard]] inline double squared_distance(const Point& p, const Point& q) {
  const Point way = difference(q, p);
  return dot(way, way);
}

class NearestVertex {
 public:
  struct Answer {
    std::int32_t vertex;  ///< index into the points; the lowest id if several are equally near
    double squared_distance;
  };
  /// Copies the points. `ids`: per point, or empty if the indices are the ids. O(n log n).
  explicit NearestVertex(std::span<const Point> points, std::span<const GlobalId> ids = {});
  /// Of these points only, by index.
  NearestVertex(std::span<const Point> points, std::span<const GlobalId> ids,
                std::vector<std::int32_t> vertices);

  /// A vertex near a point. They are ordered by distance, then by id.
  struct Neighbour {
    double squared_distance = 0;
    GlobalId id = 0;
    std::int32_t vertex = -1;
    friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
  };

  /// The `n` vertices nearest to `p` within the reach (inclusive), ascending; fewer if there are no
  /// more. `out` is overwritten.
  void find(const Point& p, std::size_t n, double squared_reach, std::vector<Neighbour>& out) const;
  /// The vertex nearest to `p` within the reach (inclusive); vertex -1 if there is none.
  [[nodiscard]] Answer find(const Point& p,
                            double squared_reach = std::numeric_limits<double>::infinity()) const;

 private:
  /// A range of vertices. An inner node divides it between two children.
  struct Node {
    Aabb box;
    std::int32_t first, last;  // positions in the tree's order
    std::int32_t second = -1;  // second child, -1 in a leaf; the first child follows its parent
  };
  void build(std::int32_t first, std::int32_t last);
  /// Calls see(position in the tree's order, squared distance) for vertices within the reach, which
  /// it may shorten, and others near these.
  template <class See>
  void visit(const Point& p, const double& squared_reach, const See& see) const;

  std::vector<Point> points_;           // in the tree's order
  std::vector<std::int32_t> vertices_;  // their indices
  std::vector<GlobalId> ids_;           // of these
  std::vector<Node> nodes_;
};

}  // namespace tess::m2m
