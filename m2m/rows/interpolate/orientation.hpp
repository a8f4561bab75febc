// The exact sign of a 3 × 3 determinant of differences. Plain floating point decides if the result
// exceeds an error bound; otherwise expansions do (Shewchuk 1997, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates"). The sign is exact while no
// intermediate result leaves the range of double, that is for edges from 1e-80 to 1e100.
//
// The value is a weight, so its last bits count, too. The exact numbers of collide/shapes have no
// such range, but near a plane they take twice the time of expansions (0.66 instead of 0.35 µs),
// and round the value differently in one of twenty cases.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstddef>

namespace tess::m2m {

/// The corners of the face opposite to each corner, outward from a tetrahedron that is not
/// inverted. For a point inside, its orientations to the four faces have the sign of the
/// tetrahedron.
inline constexpr std::array<std::array<std::size_t, 3>, 4> faces_of_tet{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// det(a - p, b - p, c - p), rounded. Its sign is exact; zero means coplanar. Takes about 5 ns if
/// the error bound decides.
[[nodiscard]] double orientation(const Point& p, const Point& a, const Point& b, const Point& c);

/// The same determinant to a few ulps, always by expansions. Takes about 0.3 µs.
[[nodiscard]] double orientation_exact(const Point& p, const Point& a, const Point& b,
                                       const Point& c);

/// If |orientation| exceeds this multiple of the sum of the absolute products, its sign is right
/// (Shewchuk, errboundA).
inline constexpr double orientation_bound = 7.7715611723761e-16;

}  // namespace tess::m2m
