#include "m2m/rows/interpolate/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tess::m2m {
namespace {

struct Pair {
  double high, low;
};

Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_seen = sum - a;
  return {sum, (a - (sum - b_seen)) + (b - b_seen)};
}
Pair two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// An exact number: the sum of doubles that do not overlap, smallest first, without zeros.
template <std::size_t N>
struct Expansion {
  std::array<double, N> part;
  std::size_t n = 0;

  void push(double x) {
    if (x != 0) part[n++] = x;
  }
  /// The rounded value, summed from the smallest part on.
  [[nodiscard]] double value() const {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += part[i];
    return sum;
  }
};

/// e += x, exactly (Shewchuk, Grow-Expansion with zero elimination).
template <std::size_t N>
void grow(Expansion<N>& e, double x) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < e.n; ++i) {
    const Pair s = two_sum(x, e.part[i]);
    x = s.high;
    if (s.low != 0) e.part[n++] = s.low;
  }
  if (x != 0) e.part[n++] = x;
  e.n = n;
}

/// sum += sign * a * b, exactly.
template <std::size_t N, std::size_t A>
void add_product(Expansion<N>& sum, const Expansion<A>& a, const Expansion<2>& b, double sign) {
  for (std::size_t i = 0; i < a.n; ++i) {
    for (std::size_t j = 0; j < b.n; ++j) {
      const Pair p = two_product(a.part[i], sign * b.part[j]);
      grow(sum, p.low);
      grow(sum, p.high);
    }
  }
}

/// a - b, exactly.
Expansion<2> difference(double a, double b) {
  const Pair d = two_sum(a, -b);
  Expansion<2> e;
  e.push(d.low);
  e.push(d.high);
  return e;
}

}  // namespace

double orientation_exact(const Point& p, const Point& a, const Point& b, const Point& c) {
  std::array<std::array<Expansion<2>, 3>, 3> m;
  const std::array<const Point*, 3> rows{&a, &b, &c};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) m[r][k] = difference((*rows[r])[k], p[k]);
  }
  Expansion<192> det;  // three products of 16 by 2 parts, two doubles per product
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t u = (k + 1) % 3;
    const std::size_t v = (k + 2) % 3;
    Expansion<16> minor;
    add_product(minor, m[1][u], m[2][v], 1);
    add_product(minor, m[1][v], m[2][u], -1);
    add_product(det, minor, m[0][k], 1);
  }
  return det.value();
}

double orientation(const Point& p, const Point& a, const Point& b, const Point& c) {
  const double ax = a[0] - p[0], ay = a[1] - p[1], az = a[2] - p[2];
  const double bx = b[0] - p[0], by = b[1] - p[1], bz = b[2] - p[2];
  const double cx = c[0] - p[0], cy = c[1] - p[1], cz = c[2] - p[2];
  const double bycz = by * cz, bzcy = bz * cy, bzcx = bz * cx, bxcz = bx * cz, bxcy = bx * cy,
               bycx = by * cx;
  const double det = ax * (bycz - bzcy) + ay * (bzcx - bxcz) + az * (bxcy - bycx);
  const double size = std::abs(ax) * (std::abs(bycz) + std::abs(bzcy)) +
                      std::abs(ay) * (std::abs(bzcx) + std::abs(bxcz)) +
                      std::abs(az) * (std::abs(bxcy) + std::abs(bycx));
  if (std::abs(det) > orientation_bound * size) return det;
  if (size == 0) return 0;
  return orientation_exact(p, a, b, c);
}

}  // namespace tess::m2m
