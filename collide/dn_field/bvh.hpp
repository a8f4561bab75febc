// A bounding volume hierarchy over the triangles of a surface: nearest points, winding numbers, and
// the triangles that a segment crosses. A block of 4³ points traverses the tree once for its
// nearest triangles. Immutable once made; queries may run on any thread.
#pragma once

#include "collide/box_tree.hpp"
#include "collide/dn_field/prepared_triangle.hpp"
#include "collide/dn_field/surface.hpp"

namespace tess::dn {

struct ClosestPoint {
  double distance2 = HUGE_VAL;
  Vec3 point;
  std::uint32_t triangle = 0;  ///< number in the surface
};

/// 64 points that lie close together: input and output of a query for the nearest triangles.
struct PointBlock {
  static constexpr std::size_t size = 64;
  static constexpr std::uint64_t none = ~std::uint64_t{0};
  alignas(64) std::array<double, size> x{}, y{}, z{};
  /// In: squared limit of the search, negative for a point to be skipped. Out: squared distance of
  /// the nearest triangle.
  alignas(64) std::array<double, size> distance2{};
  /// Out: place of the nearest triangle in the tree (Bvh::triangle), or none.
  alignas(64) std::array<std::uint64_t, size> place{};
};

/// Where a segment crosses a triangle.
struct Crossing {
  double at = 0;               ///< fraction of the segment
  std::uint32_t triangle = 0;  ///< number in the surface
};

class Bvh {
 public:
  explicit Bvh(const Surface& surface);

  /// The nearest point of the surface within sqrt(`limit2`); distance2 is HUGE_VAL if there is
  /// none.
  [[nodiscard]] ClosestPoint closest(Vec3 p, double limit2 = HUGE_VAL) const;

  /// The nearest triangle of each point of a block; of several the first in the tree.
  void closest(PointBlock& block) const;

  /// False if no triangle is within sqrt(`limit2`) of `box`.
  [[nodiscard]] bool may_reach(const Bounds& box, double limit2) const;

  /// Appends all crossings of the segment, from either side, unordered. At an edge both triangles
  /// may be reported.
  void crossings(Vec3 from, Vec3 to, std::vector<Crossing>& into) const;

  /// The generalised winding number (Jacobson et al. 2013): 1 inside, 0 outside a closed surface,
  /// in between near holes. Clusters further than `accuracy` times their radius count as one dipole
  /// (Barill et al. 2018); 0 is exact.
  [[nodiscard]] double winding_number(Vec3 p, double accuracy) const;

  /// Whether the winding number at `p` exceeds 1/2, to 0.01: summed again where a coarse sum does
  /// not decide.
  [[nodiscard]] bool is_inside(Vec3 p) const;

  /// The unit normal of a triangle of the surface; zero for a degenerate one.
  [[nodiscard]] Vec3 normal(std::uint32_t triangle) const { return normals_[triangle]; }

  /// The unit normal of the nearest triangle that has one within sqrt(`limit2`); zero if there is
  /// none.
  [[nodiscard]] Vec3 nearest_normal(Vec3 p, double limit2) const;

  /// The triangle at a place of a PointBlock.
  [[nodiscard]] const PreparedTriangle& triangle(std::uint64_t place) const {
    return prepared_[place];
  }

 private:
  using Tree = collide::BoxTree<Bounds, 3>;
  using Node = Tree::Node;
  struct Moment {       // a cluster as a dipole
    Vec3 centre;        // of area
    Vec3 area_normal;   // sum over the triangles below
    double area = 0;    // sum of their sizes
    double radius = 0;  // of a ball around centre that holds all triangles below
  };

  void summarise();

  Tree tree_;  // its objects are triangles of the surface
  std::vector<Moment> moments_;
  std::vector<PreparedTriangle> prepared_;  // by place
  std::vector<Vec3> normals_;
};

}  // namespace tess::dn
