// On which side of a line or plane a point lies: exact signs for all finite coordinates. The inline
// part decides in double, with an error bound; what it cannot decide is computed in exact numbers.
// (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust geometric
// predicates"; the bound by largest differences is that of Devillers and Pion 2003.)
#pragma once

#include "collide/box.hpp"

#include <cmath>

namespace tess::collide::shapes {

/// What is left out of a point for a predicate in the plane. The other two axes follow cyclically.
enum class Dropped : std::size_t { x = 0, y = 1, z = 2 };

/// The sign of (b - a) × (c - a) along the dropped axis: 1 if a, b, c run counter-clockwise.
[[nodiscard]] int orient2d(const Point& a, const Point& b, const Point& c, Dropped axis) noexcept;

/// The sign of det(b - a, c - a, d - a): 1 if d is on the side from which a, b, c run
/// counter-clockwise.
[[nodiscard]] int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) noexcept;

/// to - from. It refers to the points.
struct Difference {
  const Point& from;
  const Point& to;
};
/// The sign of det(u, v, w) without the filter of Sides.
[[nodiscard]] int determinant_sign(const Difference& u, const Difference& v,
                                   const Difference& w) noexcept;

/// Whether three points lie on one line (or coincide).
[[nodiscard]] inline bool are_collinear(const Point& a, const Point& b, const Point& c) noexcept {
  return orient2d(a, b, c, Dropped::x) == 0 && orient2d(a, b, c, Dropped::y) == 0 &&
         orient2d(a, b, c, Dropped::z) == 0;
}

/// A plane through `origin` along two differences, for the sides of several points. It refers to
/// the points, and does not copy them.
class Sides {
 public:
  /// The plane of a triangle: of(d) is orient3d(a, b, c, d).
  Sides(const Point& a, const Point& b, const Point& c) noexcept : Sides(a, {a, b}, {a, c}) {}

  Sides(const Point& origin, const Difference& u, const Difference& v) noexcept
      : origin_(origin), u_(u), v_(v) {
    std::array<double, 3> e{}, f{}, largest{};
    for (std::size_t k = 0; k < 3; ++k) {
      e[k] = u.to[k] - u.from[k];
      f[k] = v.to[k] - v.from[k];
      const double x = std::abs(e[k]), y = std::abs(f[k]);
      largest[k] = x > y ? x : y;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      normal_[k] = e[i] * f[j] - e[j] * f[i];
      slope_[k] = 4 * (largest[i] * largest[j] + underflow);
    }
  }

  /// The side of `d` if double precision decides it, otherwise 0.
  [[nodiscard]] int certain(const Point& d) const noexcept {
    const double x = d[0] - origin_[0], y = d[1] - origin_[1], z = d[2] - origin_[2];
    const double value = x * normal_[0] + y * normal_[1] + z * normal_[2];
    const double bound = error * (std::abs(x) * slope_[0] + std::abs(y) * slope_[1] +
                                  std::abs(z) * slope_[2] + underflow);
    return static_cast<int>(value > bound) - static_cast<int>(-value > bound);
  }
  /// The side of `d`: determinant_sign(u, v, d - origin).
  [[nodiscard]] int of(const Point& d) const noexcept {
    const int side = certain(d);
    return side != 0 ? side : exact(d);
  }

 private:
  [[nodiscard]] int exact(const Point& d) const noexcept;

  // Each of the six products of the determinant has three differences with a relative error of
  // 2^-53, and passes at most five further roundings. |normal[k]| <= 2 largest[i] largest[j], so the
  // error is at most 2 · 8 · 2^-53 of the sum over |d[k]| largest[i] largest[j], and half the bound.
  // The bound is infinite or NaN if anything overflows.
  static constexpr double error = 0x1p-50;
  // A product that underflows loses at most 2^-1074, which is far below error · underflow.
  static constexpr double underflow = 0x1p-850;

  const Point& origin_;
  Difference u_, v_;
  std::array<double, 3> normal_{}, slope_{};
};

}  // namespace tess::collide::shapes
