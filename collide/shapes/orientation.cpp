#include "collide/shapes/orientation.hpp"

#include "collide/shapes/determinant.hpp"
#include "collide/shapes/sign_of.hpp"

#include <bit>
#include <cstdint>
#include <optional>

namespace tess::collide::shapes {
namespace {

__extension__ using SignedWide = __int128;

/// The sign of the determinant if the differences are multiples of one power of two, as on a grid
/// or with coordinates of few digits: in 128-bit integers, five times as fast as exact numbers.
std::optional<int> sign_on_grid(const Difference& u, const Difference& v,
                                const Difference& w) noexcept {
  constexpr int n_bits = 40;  // three factors and a sum of six products have 123 bits
  const std::array<const Difference*, 3> rows{&u, &v, &w};
  std::array<std::array<double, 3>, 3> d{};
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double to = rows[i]->to[k], from = rows[i]->from[k];
      const double x = to - from, subtracted = to - x;
      const double lost = (to - (x + subtracted)) + (subtracted - from);
      if (lost != 0) return std::nullopt;
      d[i][k] = x;
      largest = std::abs(x) > largest ? std::abs(x) : largest;
    }
  if (!(largest > 0x1p-900 && largest < 0x1p900)) return std::nullopt;
  // The power of two from the bits of the largest difference.
  const auto exponent = static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52U) - 1022;
  const double scale =
      std::bit_cast<double>(static_cast<std::uint64_t>(1023 + n_bits - exponent) << 52U);
  std::array<std::array<std::int64_t, 3>, 3> n{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = d[i][k] * scale;
      n[i][k] = static_cast<std::int64_t>(x);
      if (static_cast<double>(n[i][k]) != x || (x == 0 && d[i][k] != 0)) return std::nullopt;
    }
  SignedWide sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    sum += (SignedWide{n[0][i]} * n[1][j] - SignedWide{n[0][j]} * n[1][i]) * n[2][k];
  }
  return static_cast<int>(sum > 0) - static_cast<int>(sum < 0);
}

/// Whether a coordinate axis has no part in any of the three vectors. This is so for all triangles
/// in one plane of a grid.
bool lacks_an_axis(const Difference& u, const Difference& v, const Difference& w) noexcept {
  for (std::size_t k = 0; k < 3; ++k)
    if (u.from[k] == u.to[k] && v.from[k] == v.to[k] && w.from[k] == w.to[k]) return true;
  return false;
}

}  // namespace

int orient2d(const Point& a, const Point& b, const Point& c, Dropped axis) noexcept {
  const std::size_t i = (static_cast<std::size_t>(axis) + 1) % 3;
  const std::size_t j = (static_cast<std::size_t>(axis) + 2) % 3;
  const double left = (b[i] - a[i]) * (c[j] - a[j]);
  const double right = (b[j] - a[j]) * (c[i] - a[i]);
  // Two differences and a product each, and the last subtraction: below 4 · 2^-53 of the sum.
  const double bound = 0x1p-50 * (std::abs(left) + std::abs(right)) + 0x1p-900;
  if (left - right > bound) return 1;
  if (right - left > bound) return -1;
  if ((a[i] == b[i] && a[i] == c[i]) || (a[j] == b[j] && a[j] == c[j])) return 0;
  return sign_of([&](auto number) {
    return (number(b[i]) - number(a[i])) * (number(c[j]) - number(a[j])) -
           (number(b[j]) - number(a[j])) * (number(c[i]) - number(a[i]));
  });
}

int determinant_sign(const Difference& u, const Difference& v, const Difference& w) noexcept {
  if (lacks_an_axis(u, v, w)) return 0;
  if (const std::optional<int> sign = sign_on_grid(u, v, w)) return *sign;
  return sign_of([&](auto number) { return determinant(number, u, v, w); });
}

int Sides::exact(const Point& d) const noexcept {
  return determinant_sign(u_, v_, {origin_, d});
}

int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) noexcept {
  return Sides(a, b, c).of(d);
}

}  // namespace tess::collide::shapes
