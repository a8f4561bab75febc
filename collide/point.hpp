// A point or a vector in space, and its arithmetic. The sums are from left to right: results are
// compared by their bits.
#pragma once

#include <array>
#include <cmath>

namespace tess::collide {

using Point = std::array<double, 3>;

/// a - b.
[[nodiscard]] constexpr Point difference(const Point& a, const Point& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] constexpr double dot(const Point& a, const Point& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] constexpr Point cross(const Point& a, const Point& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// It does not scale: squares of coordinates must be in the range of double.
[[nodiscard]] inline double length(const Point& a) noexcept {
  return std::sqrt(dot(a, a));
}

}  // namespace tess::collide
