// A point or vector in double precision, for surfaces, frames and single particles. Loops over many
// particles use structure of arrays: see particles.hpp.
#pragma once

#include <algorithm>
#include <cmath>

namespace tess::dn {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
  constexpr Vec3& operator+=(const Vec3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
};

constexpr double dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(Vec3 a) {
  return std::sqrt(dot(a, a));
}
inline bool is_finite(Vec3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// The unit vector along `a`, or zero for a zero vector.
inline Vec3 direction(Vec3 a) {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : Vec3{};
}

constexpr double component(Vec3 a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

/// A part of a line p + t way; empty where first > last.
struct LinePart {
  double first = -HUGE_VAL, last = HUGE_VAL;
};

/// An axis-aligned box, empty until extended.
struct Bounds {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3 high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void extend(Vec3 p) {
    low = {std::fmin(low.x, p.x), std::fmin(low.y, p.y), std::fmin(low.z, p.z)};
    high = {std::fmax(high.x, p.x), std::fmax(high.y, p.y), std::fmax(high.z, p.z)};
  }
  [[nodiscard]] Vec3 size() const { return high - low; }
  [[nodiscard]] Vec3 centre() const { return 0.5 * (low + high); }

  /// Squared distance from `p` to the box; zero inside.
  [[nodiscard]] double distance2(Vec3 p) const { return distance2(Bounds{p, p}); }
  /// Squared distance between two boxes; zero where they overlap.
  [[nodiscard]] double distance2(const Bounds& b) const {
    const double dx = std::max({0.0, low.x - b.high.x, b.low.x - high.x});
    const double dy = std::max({0.0, low.y - b.high.y, b.low.y - high.y});
    const double dz = std::max({0.0, low.z - b.high.z, b.low.z - high.z});
    return dx * dx + dy * dy + dz * dz;
  }
  /// The part of the line p + t way in the box.
  [[nodiscard]] LinePart part_of_line(Vec3 p, Vec3 way) const {
    LinePart part;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = component(way, axis);
      const double to_low = component(low - p, axis), to_high = component(high - p, axis);
      if (d == 0) {
        if (to_low > 0 || to_high < 0) return {HUGE_VAL, -HUGE_VAL};
        continue;
      }
      part.first = std::max(part.first, std::min(to_low / d, to_high / d));
      part.last = std::min(part.last, std::max(to_low / d, to_high / d));
    }
    return part;
  }
};

}  // namespace tess::dn
