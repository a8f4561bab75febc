// Points inside of a closed surface, how deep they are, and the shortest way out. After a collision
// of two models has found the triangles in contact, only their corners need be asked for:
//
//     const ClosedModel solid{std::span<const Triangle>(b)};
//     for (const PenetratingPoint& p : penetrating_points(a, triangles_of_a_in_contact, solid)) …
//
// Inside is where the surface winds around the point, once or more, in either direction. That is
// decided exactly: along a ray, with points moved by an infinitesimal amount off the edges that it
// meets (Edelsbrunner and Mücke 1990). A surface may intersect itself. Immutable; any thread.
#pragma once

#include "collide/queries.hpp"

namespace tess::collide {

/// The nearest point of a surface, seen from inside.
struct Penetration {
  double depth;            ///< distance to it
  Point nearest;           ///< on the surface
  Point direction;         ///< unit vector to it: by depth · direction the point is out
  std::uint32_t triangle;  ///< position of a triangle on which it is; the first of several
};

/// The triangles of a closed surface. Its triangles are oriented alike, and meet at corners with
/// equal coordinates.
class ClosedModel {
 public:
  /// Throws Error (bad_mesh) for an edge without an opposite one, with the triangle and its
  /// corners, and Error (bad_value) for a triangle that is not finite.
  explicit ClosedModel(std::span<const Triangle> triangles);

  /// Says how often the surface winds around `p`: 1 inside if its normals point outward, 0 outside.
  /// On the surface it is that of one of its sides.
  [[nodiscard]] int winding_number(const Point& p) const;

  /// Gives nothing if `p` is outside or on the surface. It costs one ray, and one nearest triangle
  /// if `p` is inside. Lengths have a relative error below 2^-42.
  [[nodiscard]] std::optional<Penetration> penetration(const Point& p) const;

 private:
  Index<Triangle> triangles_;
};

struct PenetratingPoint {
  Point point;
  Penetration penetration;
};

/// The corners of some triangles that are inside of `model`, each position once, in lexicographic
/// order. `which`: positions in `triangles`; throws Error (bad_value) for one that is none.
[[nodiscard]] std::vector<PenetratingPoint> penetrating_points(std::span<const Triangle> triangles,
                                                               std::span<const std::uint32_t> which,
                                                               const ClosedModel& model);

}  // namespace tess::collide
