// What the exact tests of shapes are compared with: convex hulls of points with small integer
// coordinates, in 64-bit integers, by another method than the library's. Hulls A and B intersect if
// the origin lies in the hull of all differences a - b, that is (Carathéodory) in a simplex of at
// most four affinely independent ones.
#pragma once

#include "collide/box.hpp"

#include <random>
#include <span>
#include <vector>

namespace tess::collide::testing {

inline constexpr std::array both{Touching::counts, Touching::does_not_count};

using Integer = std::int64_t;
using Vector = std::array<Integer, 3>;

inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Integer dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline std::vector<Vector> differences(std::span<const Point> a, std::span<const Point> b) {
  std::vector<Vector> out;
  for (const Point& p : a)
    for (const Point& q : b) {
      Vector d{};
      for (std::size_t k = 0; k < 3; ++k) d[k] = static_cast<Integer>(p[k] - q[k]);
      out.push_back(d);
    }
  return out;
}

/// Whether the origin is in the hull of the points.
inline bool holds_origin(const std::vector<Vector>& p) {
  const Vector zero{};
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (p[i] == zero) return true;
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vector ij = cross(p[i], p[j]);
      if (ij == zero && dot(p[i], p[j]) < 0) return true;
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vector jk = cross(p[j], p[k]), ki = cross(p[k], p[i]);
        const Integer volume = dot(ij, p[k]);
        if (volume == 0) {
          const Vector normal{ij[0] + jk[0] + ki[0], ij[1] + jk[1] + ki[1], ij[2] + jk[2] + ki[2]};
          if (normal != zero && dot(ij, normal) >= 0 && dot(jk, normal) >= 0 &&
              dot(ki, normal) >= 0)
            return true;
          continue;
        }
        // The origin is -(a p_i + b p_j + c p_k) / p_l with positive weights.
        const Integer sign = volume > 0 ? -1 : 1;
        for (std::size_t l = k + 1; l < n; ++l)
          if (sign * dot(ij, p[l]) >= 0 && sign * dot(jk, p[l]) >= 0 && sign * dot(ki, p[l]) >= 0 &&
              p[l] != zero)
            return true;
      }
    }
  }
  return false;
}

/// Whether the origin is in the interior of the hull of the points: they span space, and no plane
/// through the origin and two of them has all others on one side.
inline bool surrounds_origin(const std::vector<Vector>& p) {
  bool spans_space = false;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      const Vector normal = cross(p[i], p[j]);
      if (normal == Vector{}) continue;
      bool above = false, below = false;
      for (const Vector& q : p) {
        above |= dot(normal, q) > 0;
        below |= dot(normal, q) < 0;
      }
      if (!above || !below) return false;
      spans_space = true;
    }
  return spans_space;
}

inline bool oracle(std::span<const Point> a, std::span<const Point> b, Touching touching) {
  const std::vector<Vector> all = differences(a, b);
  return touching == Touching::counts ? holds_origin(all) : surrounds_origin(all);
}

/// Points with integer coordinates within [0, size).
class SmallPoints {
 public:
  explicit SmallPoints(std::uint64_t seed) : random_(seed) {}

  Point point(int size) {
    std::uniform_int_distribution<int> coordinate(0, size - 1);
    return {double(coordinate(random_)), double(coordinate(random_)), double(coordinate(random_))};
  }
  template <std::size_t N>
  std::array<Point, N> points(int size) {
    std::array<Point, N> out{};
    for (Point& p : out) p = point(size);
    return out;
  }
  /// A whole number below n.
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  std::mt19937_64& random() { return random_; }

 private:
  std::mt19937_64 random_;
};

}  // namespace tess::collide::testing
