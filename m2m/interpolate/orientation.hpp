// The sign of a 3 × 3 determinant of differences, exactly: floating point behind an error bound,
// and where the bound does not decide, expansions (Shewchuk 1997, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates"). Exact while no intermediate
// leaves the range of double: edges from 1e-80 to 1e100.
#pragma once

#include "m2m/mesh.hpp"

namespace tess::m2m {

/// det(a - p, b - p, c - p) rounded; its sign is exact, zero means coplanar. About 5 ns where the
/// error bound decides.
[[nodiscard]] double orientation(const Point& p, const Point& a, const Point& b, const Point& c);

/// The same to a few ulps of its own value, always by expansions: about 0.3 µs.
[[nodiscard]] double orientation_exact(const Point& p, const Point& a, const Point& b,
                                       const Point& c);

/// |orientation| above this multiple of the sum of absolute products has the right sign (Shewchuk,
/// errboundA).
inline constexpr double orientation_bound = 7.7715611723761e-16;

}  // namespace tess::m2m
