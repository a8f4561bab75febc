// Axis-aligned bounding boxes and their overlap. By default a box is closed: [lo, hi] contains both
// corners, so boxes that share a face, an edge or a corner overlap. A point is a box of zero size.
// An overlap is decided by comparisons, without arithmetic, so the answer is exact. In a valid box
// all six numbers are finite, and lo <= hi on each axis (is_valid()).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace tess::collide {

using Point = std::array<double, 3>;

/// Whether boxes that share only a face, an edge or a corner overlap.
enum class Touching { counts, does_not_count };

/// The closed box [lo, hi]: an aggregate of 48 bytes that is sent as bytes.
struct Aabb {
  Point lo;
  Point hi;

  friend bool operator==(const Aabb&, const Aabb&) = default;
};

/// The box of zero size at `point`.
[[nodiscard]] inline Aabb box_of(const Point& point) noexcept {
  return {point, point};
}

/// The smallest box that contains both.
[[nodiscard]] inline Aabb merged(const Aabb& a, const Aabb& b) noexcept {
  Aabb out = a;
  for (std::size_t k = 0; k < 3; ++k) {
    out.lo[k] = std::min(a.lo[k], b.lo[k]);
    out.hi[k] = std::max(a.hi[k], b.hi[k]);
  }
  return out;
}

/// The smallest box that contains all points. Without points: lo = +inf, hi = -inf.
[[nodiscard]] inline Aabb box_around(std::span<const Point> points) noexcept {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Aabb out{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const Point& point : points) out = merged(out, box_of(point));
  return out;
}

/// False if a number is NaN or infinite, or if lo > hi on an axis.
[[nodiscard]] inline bool is_valid(const Aabb& box) noexcept {
  for (std::size_t k = 0; k < 3; ++k)
    if (!std::isfinite(box.lo[k]) || !std::isfinite(box.hi[k]) || box.lo[k] > box.hi[k])
      return false;
  return true;
}

/// True if two valid boxes overlap. If touching does not count, a point overlaps the boxes that it
/// is strictly inside of, and two equal points do not overlap.
[[nodiscard]] inline bool overlap(const Aabb& a, const Aabb& b, Touching touching) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const bool apart = touching == Touching::counts ? a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]
                                                    : a.lo[k] >= b.hi[k] || b.lo[k] >= a.hi[k];
    if (apart) return false;
  }
  return true;
}

}  // namespace tess::collide
