// Squared distances from a point to the shapes of the library.
#pragma once

#include "collide/tetrahedron.hpp"

namespace tess::collide {

/// Squared distance from `p`; 0 in a box, ball or tetrahedron. The relative error is below 2^-43,
/// also for needles and next to the surface: what cancels is computed exactly. That of a ball is
/// relative to the squared radius where it is larger. Squares overflow beyond distances of 1e154,
/// and underflow below 1e-154.
[[nodiscard]] double distance2(const Point& object, const Point& p) noexcept;
[[nodiscard]] double distance2(const Aabb& object, const Point& p) noexcept;
[[nodiscard]] double distance2(const Segment& object, const Point& p) noexcept;
[[nodiscard]] double distance2(const Triangle& object, const Point& p) noexcept;
[[nodiscard]] double distance2(const Sphere& object, const Point& p) noexcept;
[[nodiscard]] double distance2(const Tetrahedron& object, const Point& p) noexcept;

/// The way from `p` to the nearest point of a triangle. The relative error of each component is below
/// 2^-43, however near `p` is.
[[nodiscard]] Point offset_to(const Triangle& triangle, const Point& p) noexcept;

/// The point of a triangle that is nearest to `p`: p + offset_to(), rounded.
[[nodiscard]] Point nearest_point(const Triangle& triangle, const Point& p) noexcept;

/// The weights of the corners, or ends, at the point that is nearest to `p`. The face, the edge or
/// the corner that holds the point is decided exactly: its corners have positive weights, each with
/// a relative error below 2^-43, and the others have 0. A weight that stands alone is 1.
[[nodiscard]] std::array<double, 3> nearest_weights(const Triangle& triangle,
                                                    const Point& p) noexcept;
[[nodiscard]] std::array<double, 2> nearest_weights(const Segment& segment,
                                                    const Point& p) noexcept;

}  // namespace tess::collide
