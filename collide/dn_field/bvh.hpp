// A tree of boxes over the triangles of a surface, for the two questions that construction asks of
// every voxel, which point of the surface is closest, and how often does the surface wind around
// me, and for what a straight way crosses. Voxels ask for the closest triangle as a block of 4³,
// which walks the tree once. Immutable once made; queries may run on any thread.
#pragma once

#include "collide/dn_field/prepared_triangle.hpp"
#include "collide/dn_field/surface.hpp"

namespace tess::dn {

struct ClosestPoint {
  double distance2 = HUGE_VAL;
  Vec3 point;
  std::uint32_t triangle = 0;  ///< number in the surface the tree was made from
};

/// 64 points that lie close together and what is closest to each; the shape of a question and its
/// answer.
struct PointBlock {
  static constexpr std::size_t size = 64;
  static constexpr std::uint64_t none = ~std::uint64_t{0};
  alignas(64) std::array<double, size> x{}, y{}, z{};
  /// In: squared distance beyond which nobody asks, negative for a point that does not ask. Out:
  /// that of the closest triangle.
  alignas(64) std::array<double, size> distance2{};
  /// Out: place of the closest triangle in the tree (Bvh::triangle), or none.
  alignas(64) std::array<std::uint64_t, size> place{};
};

/// Where a segment crosses a triangle.
struct Crossing {
  double at = 0;               ///< of the way, 0 … 1
  std::uint32_t triangle = 0;  ///< number in the surface the tree was made from
};

/// A winding number for all points of a ball, and an estimate of how far off it is anywhere in it.
struct WindingEstimate {
  double value = 0;
  double error = 0;
};

class Bvh {
 public:
  explicit Bvh(const Surface& surface);

  /// The closest point of the surface nearer than sqrt(`limit2`); distance2 stays HUGE_VAL where
  /// there is none.
  [[nodiscard]] ClosestPoint closest(Vec3 p, double limit2 = HUGE_VAL) const;

  /// The closest triangle of each point of a block; of several the first in the tree. The answer
  /// for a point depends on its block, not on who asks or in which order.
  void closest(PointBlock& block) const;

  /// Whether the box of some leaf comes nearer than sqrt(`limit2`) to `box`. False: no triangle
  /// does.
  [[nodiscard]] bool may_reach(const Bounds& box, double limit2) const;

  /// Appends all crossings of the segment, from either side, in no order. At an edge between two
  /// triangles both may tell.
  void crossings(Vec3 from, Vec3 to, std::vector<Crossing>& into) const;

  /// The generalised winding number (Jacobson et al. 2013): 1 inside, 0 outside a closed surface,
  /// in between near holes. Clusters further than `accuracy` times their radius count as one dipole
  /// (Barill et al. 2018); 0: exact everywhere.
  [[nodiscard]] double winding_number(Vec3 p, double accuracy) const;

  /// The winding number at `p` with an estimate of its error in the ball of `radius` around `p`;
  /// clusters further than `accuracy` times their radius and the ball's count as one dipole, an
  /// infinite `accuracy` lets none. The error is infinite where a triangle may pass through the
  /// ball, or lies so close to `p` that its side is rounding.
  [[nodiscard]] WindingEstimate winding_estimate(Vec3 p, double radius, double accuracy) const;

  /// Whether `p` is inside by the winding number; where the approximation is not decided it is
  /// evaluated exactly.
  [[nodiscard]] bool is_inside(Vec3 p) const;

  /// The unit normal of a triangle of the surface; zero for a degenerate one.
  [[nodiscard]] Vec3 normal(std::uint32_t triangle) const { return normals_[triangle]; }

  /// The triangle at a place of a PointBlock.
  [[nodiscard]] const PreparedTriangle& triangle(std::uint64_t place) const {
    return prepared_[place];
  }

 private:
  static constexpr std::size_t max_depth =
      64;  // splits are at the median: log2 of the number of triangles
  struct Node {
    Bounds box;
    std::uint32_t first = 0;  // leaf: first triangle; inner: first of two children
    std::uint32_t count = 0;  // leaf: number of triangles; inner: 0
  };
  struct Moment {       // what a cluster looks like from afar
    Vec3 centre;        // of area
    Vec3 area_normal;   // sum over the triangles below
    double area = 0;    // sum of their sizes
    double radius = 0;  // of a ball around centre that holds all triangles below
  };

  void summarise();

  std::vector<Node> nodes_;  // children stand behind their parent
  std::vector<Moment> moments_;
  std::vector<PreparedTriangle> prepared_;  // in leaf order
  std::vector<std::uint32_t> order_;        // leaf order -> triangle of the surface
  std::vector<Vec3> normals_;
};

}  // namespace tess::dn
