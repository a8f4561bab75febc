// A tree of boxes over the triangles of a surface, for the two questions that construction asks of
// every voxel: which point of the surface is closest, and how often does the surface wind around
// me. Immutable once made; queries may run on any thread.
#pragma once

#include "collide/dn_field/surface.hpp"

namespace tess::dn {

struct ClosestPoint {
  double distance2 = HUGE_VAL;
  Vec3 point;
  std::uint32_t triangle = 0;  ///< number in the surface the tree was made from
};

class Bvh {
 public:
  explicit Bvh(const Surface& surface);

  /// The closest point of the surface nearer than sqrt(`limit2`); distance2 stays HUGE_VAL where
  /// there is none.
  [[nodiscard]] ClosestPoint closest(Vec3 p, double limit2 = HUGE_VAL) const;

  /// The generalised winding number (Jacobson et al. 2013): 1 inside, 0 outside a closed surface,
  /// in between near holes. Clusters further than `accuracy` times their radius count as one dipole
  /// (Barill et al. 2018); 0: exact everywhere.
  [[nodiscard]] double winding_number(Vec3 p, double accuracy) const;

  /// Whether `p` is inside by the winding number; where the approximation is not decided it is
  /// evaluated exactly.
  [[nodiscard]] bool is_inside(Vec3 p) const;

  /// The unit normal of a triangle of the surface; zero for a degenerate one.
  [[nodiscard]] Vec3 normal(std::uint32_t triangle) const { return normals_[triangle]; }

 private:
  struct Node {
    Bounds box;
    Vec3 centre;              // of area
    Vec3 area_normal;         // sum over the triangles below
    double radius = 0;        // of the ball around centre that holds all triangles below
    std::uint32_t first = 0;  // leaf: first triangle; inner: first of two children
    std::uint32_t count = 0;  // leaf: number of triangles; inner: 0
  };

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t last);
  void summarise(Node& node, std::uint32_t first, std::uint32_t last) const;

  std::vector<Node> nodes_;
  std::vector<std::array<Vec3, 3>> corners_;  // in leaf order
  std::vector<std::uint32_t> order_;          // leaf order -> triangle of the surface
  std::vector<Vec3> normals_;
};

}  // namespace tess::dn
