// Axis-aligned boxes and their overlap. By default a box is closed: [lo, hi] contains both corners,
// so boxes that share a face, an edge or a corner overlap. A point is a box of zero size. An
// overlap is decided by comparisons, without arithmetic, so the answer is exact. In a valid box all
// numbers are finite, and lo <= hi on each axis (is_valid()).
#pragma once

#include "collide/point.hpp"
#include "runtime/core/algorithm.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace tess::collide {

/// Whether boxes that share only a face, an edge or a corner overlap.
enum class Touching { counts, does_not_count };

/// The closed box [lo, hi] in 2, 3 or 4 dimensions: an aggregate that is sent as bytes.
template <class Real, std::size_t D>
struct Box {
  std::array<Real, D> lo;
  std::array<Real, D> hi;

  friend bool operator==(const Box&, const Box&) = default;
};

using Aabb = Box<double, 3>;

/// The box of zero size at `point`.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> box_of(const std::array<Real, D>& point) noexcept {
  return {point, point};
}
/// A box is its own box.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> box_of(const Box<Real, D>& box) noexcept {
  return box;
}

/// Gives the same box in double.
template <class Real>
[[nodiscard]] Aabb in_double(const Box<Real, 3>& box) noexcept {
  Aabb out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.lo[k] = box.lo[k];
    out.hi[k] = box.hi[k];
  }
  return out;
}

/// The smallest box that contains both.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> merged(const Box<Real, D>& a, const Box<Real, D>& b) noexcept {
  Box<Real, D> out = a;
  for (std::size_t k = 0; k < D; ++k) {
    out.lo[k] = std::min(a.lo[k], b.lo[k]);
    out.hi[k] = std::max(a.hi[k], b.hi[k]);
  }
  return out;
}

/// Contains nothing, and merged(nothing, box) == box: lo = +inf, hi = -inf.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> no_box() noexcept {
  constexpr Real inf = std::numeric_limits<Real>::infinity();
  Box<Real, D> out;
  out.lo.fill(inf);
  out.hi.fill(-inf);
  return out;
}

/// Extends a box so that it contains the point.
inline void grow(Aabb& box, const Point& p) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = p[k] < box.lo[k] ? p[k] : box.lo[k];
    box.hi[k] = p[k] > box.hi[k] ? p[k] : box.hi[k];
  }
}

/// The smallest box that contains all points; no_box() without points.
[[nodiscard]] inline Aabb box_around(std::span<const Point> points) noexcept {
  Aabb out = no_box<double, 3>();
  for (const Point& point : points) grow(out, point);
  return out;
}

/// The smallest box that contains all corners of a shape. It is not valid (is_valid()) if a
/// coordinate is NaN or infinite, wherever it stands.
template <class Real, std::size_t D, std::size_t N>
[[nodiscard]] Box<Real, D> box_around(const std::array<std::array<Real, D>, N>& corners) noexcept {
  Box<Real, D> out = box_of(corners[0]);
  for (std::size_t i = 1; i < N; ++i)
    for (std::size_t k = 0; k < D; ++k) {
      const Real x = corners[i][k];
      out.lo[k] = x < out.lo[k] || std::isnan(x) ? x : out.lo[k];
      out.hi[k] = x > out.hi[k] || std::isnan(x) ? x : out.hi[k];
    }
  return out;
}

/// False if a number is NaN or infinite, or if lo > hi on an axis.
template <class Real, std::size_t D>
[[nodiscard]] bool is_valid(const Box<Real, D>& box) noexcept {
  for (std::size_t k = 0; k < D; ++k)
    if (!std::isfinite(box.lo[k]) || !std::isfinite(box.hi[k]) || box.lo[k] > box.hi[k])
      return false;
  return true;
}

/// True if two valid boxes overlap. If touching does not count, a point overlaps the boxes that it
/// is strictly inside of, and two equal points do not overlap.
template <class Real, std::size_t D>
[[nodiscard]] bool overlap(const Box<Real, D>& a, const Box<Real, D>& b,
                           Touching touching) noexcept {
  for (std::size_t k = 0; k < D; ++k) {
    const bool apart = touching == Touching::counts ? a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]
                                                    : a.lo[k] >= b.hi[k] || b.lo[k] >= a.hi[k];
    if (apart) return false;
  }
  return true;
}

}  // namespace tess::collide
