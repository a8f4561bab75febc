// Exact tests of the convex hulls of up to four points each, of any kind: tetrahedra, triangles,
// segments and points, degenerate ones included. They decide every case, and are the slow path of
// the faster tests.
#pragma once

#include "collide/box.hpp"

#include <span>

namespace tess::collide::shapes {

/// Whether the convex hulls of `a` and `b` have a common point. Hulls that are apart are separated
/// by a plane that is parallel to two of their edges (Gottschalk, Lin and Manocha 1996); in one
/// plane by a line along an edge; on one line by their boxes.
[[nodiscard]] bool hulls_intersect(std::span<const Point> a, std::span<const Point> b) noexcept;

/// Whether they still have a common point after every small enough translation of one of them.
[[nodiscard]] bool hulls_cross(std::span<const Point> a, std::span<const Point> b) noexcept;

/// Whether the difference of the hulls, the set of all p - q, is a body with volume.
[[nodiscard]] bool difference_has_volume(std::span<const Point> a,
                                         std::span<const Point> b) noexcept;

}  // namespace tess::collide::shapes
