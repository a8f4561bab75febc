// An axis-aligned bounding box, and what it means for two of them to touch. Boxes are closed unless
// asked otherwise: [lo, hi] contains both corners, so that boxes that share a face, an edge or a
// corner overlap. A point is a box of zero size. Only comparisons decide an overlap, never
// arithmetic: the answer is exact. Invariant of a valid box: all six numbers finite, lo <= hi on
// each axis (see is_valid()).
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

/// Closed box [lo, hi]; a plain aggregate of 48 bytes that travels as bytes.
struct Aabb {
  Point lo;
  Point hi;

  friend bool operator==(const Aabb&, const Aabb&) = default;
};

/// The box of zero size at `point`.
[[nodiscard]] inline Aabb box_of(const Point& point) noexcept {
  return {point, point};
}

/// The smallest box that holds both.
[[nodiscard]] inline Aabb merged(const Aabb& a, const Aabb& b) noexcept {
  Aabb out = a;
  for (std::size_t k = 0; k < 3; ++k) {
    out.lo[k] = std::min(a.lo[k], b.lo[k]);
    out.hi[k] = std::max(a.hi[k], b.hi[k]);
  }
  return out;
}

/// The smallest box that holds all points; of none, lo = +inf and hi = -inf.
[[nodiscard]] inline Aabb box_around(std::span<const Point> points) noexcept {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Aabb out{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const Point& point : points) out = merged(out, box_of(point));
  return out;
}

/// False for a NaN, an infinity, or lo > hi on any axis.
[[nodiscard]] inline bool is_valid(const Aabb& box) noexcept {
  for (std::size_t k = 0; k < 3; ++k)
    if (!std::isfinite(box.lo[k]) || !std::isfinite(box.hi[k]) || box.lo[k] > box.hi[k])
      return false;
  return true;
}

/// Do two valid boxes overlap? A point strictly within an open box does; two equal points only
/// where touching counts.
[[nodiscard]] inline bool overlap(const Aabb& a, const Aabb& b, Touching touching) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const bool apart = touching == Touching::counts ? a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]
                                                    : a.lo[k] >= b.hi[k] || b.lo[k] >= a.hi[k];
    if (apart) return false;
  }
  return true;
}

}  // namespace tess::collide
