// The surface of a body, and the test whether a point lies inside it. The winding number of a point
// is the sum of the signs with which the ray in +x passes through the triangles (crossing.hpp). It is
// 0 outside, and a whole number elsewhere; a point is inside if it is not 0. So triangles may face
// inwards or outwards, bodies may overlap, and a body may have cavities, which face the other way.
//
// The signs are exact, so the tolerance is zero: no point is misclassified, however near to the
// surface. A tree of boxes finds the triangles that the ray can meet.
//
// A surface that is not closed gets flat caps (rim.hpp), and the answers are exact for the result.
// Where it stands on planes of symmetry it is closed beyond them: answers are exact in the domain.
#pragma once

#include "collide/box_tree.hpp"
#include "m2m/overset/crossing.hpp"
#include "m2m/overset/rim.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// Where a point lies with respect to a body.
enum class Containment : std::uint8_t { outside, on_wall, inside };

/// Immutable; queries may run on any thread. It takes about 130 bytes per triangle.
class Wall {
 public:
  /// A wall with a larger Rim::cap_share is refused: a box without one side has 1/6.
  static constexpr double most_capped = 0.2;

  Wall() = default;
  /// `points`: in any unit; `triangles`: indices into points. Points at the same place become one.
  /// Throws Error (bad_mesh) if there is no triangle with an area, an index is out of range, a
  /// coordinate is not finite or exceeds 1e100, the surface is too open, or a hole of it lies in
  /// planes of symmetry in part only.
  Wall(std::span<const Point> points, std::span<const std::array<VertexId, 3>> triangles,
       std::span<const SymmetryPlane> symmetry = {});

  /// Exact if differences of coordinates are 0 or at least 1e-80 of the largest coordinate. Takes
  /// 0.3 to 1.2 µs within the box() of a wall of 2e2 to 1e5 triangles, a few ns outside: a fifth of
  /// the time of a sum of solid angles with dipoles (Barill et al. 2018).
  [[nodiscard]] Containment locate(const Point& p) const;

  /// The winding number of a point that is not on the wall.
  [[nodiscard]] int winding_number(const Point& p) const;

  /// Those triangles that matter to the points of a box: the answers there are the same. A piece of
  /// a mesh needs no more of a large wall.
  [[nodiscard]] Wall seen_from(const Aabb& box) const;

  /// Holds the triangles, and those that close the wall.
  [[nodiscard]] Aabb box() const;
  [[nodiscard]] std::size_t n_triangles() const { return triangles_.size(); }
  [[nodiscard]] const Rim& rim() const { return rim_; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(triangles_, scale_, rim_);
    if constexpr (Ar::is_reading) build();
  }

 private:
  using Tree = collide::BoxTree<Aabb, 3>;
  struct Sum {
    int winding = 0;
    bool is_on_wall = false;
  };

  void build();
  [[nodiscard]] Point scaled(const Point& p) const {
    return {p[0] * scale_, p[1] * scale_, p[2] * scale_};
  }
  [[nodiscard]] Sum sum(const Point& p) const;

  std::vector<WallTriangle> triangles_;  // scaled, in the order of the tree
  double scale_ = 1;                     // a power of two: the largest coordinate becomes 1/2 to 1
  Rim rim_;
  Tree tree_;
};

}  // namespace tess::m2m
