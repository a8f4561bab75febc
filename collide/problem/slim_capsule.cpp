#include "collide/problem/slim_capsule.hpp"

#include "runtime/core/simd.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tess::collide::search {
namespace {

constexpr std::size_t width = 8;

/// A number of eight capsules per row.
struct Columns {
  alignas(32) float of[sizeof(SlimCapsule) / sizeof(float)][width];
};

/// Puts eight capsules into columns: a transposition in three rounds of shuffles.
void gather(const SlimCapsule* capsules, const std::uint32_t* which, Columns& columns) noexcept {
  using Eight = simd::Vector<float, width>;
  static_assert(sizeof(SlimCapsule) == sizeof(Eight) && sizeof(Columns) == width * sizeof(Eight));
  Eight x[width], y[width];
  for (std::size_t l = 0; l < width; ++l) std::memcpy(&x[l], &capsules[which[l]], sizeof(Eight));
  for (std::size_t l = 0; l < width; l += 2) {
    y[l] = __builtin_shufflevector(x[l], x[l + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    y[l + 1] = __builtin_shufflevector(x[l], x[l + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (std::size_t l = 0; l < width; l += 4)
    for (std::size_t i = 0; i < 2; ++i) {
      const Eight &a = y[l + i], &b = y[l + i + 2];
      x[l + 2 * i] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
      x[l + 2 * i + 1] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (std::size_t l = 0; l < width / 2; ++l) {
    y[l] = __builtin_shufflevector(x[l], x[l + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    y[l + 4] = __builtin_shufflevector(x[l], x[l + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
  std::memcpy(columns.of, y, sizeof columns.of);
}

float largest(float x, float y, float z) noexcept {
  return std::max(std::max(std::abs(x), std::abs(y)), std::abs(z));
}

/// Per lane: 0 if the capsules are certainly apart along the cross product of their directions.
///
/// With u = 2^-24 and the largest coordinates A and B of the directions, and W of the way between
/// their starts: each coordinate of the rounded normal is within 4u AB of the cross product, so the
/// directions have at most 12u AB (A + B) along it. It is below 2.1 AB, so the product with the way
/// has an error below 4u · 3 · 2.1 AB W. Together that is less than 32u AB (A + B + W). 2^-100 is
/// more than what underflows, and the sum of coordinates no less than the length of the normal.
void compare(const Columns& a, const Columns& b, std::uint32_t (&may_meet)[width]) noexcept {
  for (std::size_t l = 0; l < width; ++l) {
    const float ax = a.of[3][l], ay = a.of[4][l], az = a.of[5][l];
    const float bx = b.of[3][l], by = b.of[4][l], bz = b.of[5][l];
    const float wx = b.of[0][l] - a.of[0][l], wy = b.of[1][l] - a.of[1][l],
                wz = b.of[2][l] - a.of[2][l];
    const float nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
    const float apart = std::abs(nx * wx + ny * wy + nz * wz);
    const float thick = (a.of[6][l] + b.of[6][l]) * (std::abs(nx) + std::abs(ny) + std::abs(nz));
    const float size_a = largest(ax, ay, az), size_b = largest(bx, by, bz);
    const float error =
        0x1p-19F * size_a * size_b * (size_a + size_b + largest(wx, wy, wz)) + 0x1p-100F;
    may_meet[l] = apart > thick + error ? 0 : 1;  // 1 also for NaN
  }
}

}  // namespace

Frame frame_of(const Aabb& bounds) noexcept {
  Frame out;
  double widest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    out.centre[k] = bounds.lo[k] / 2 + bounds.hi[k] / 2;
    widest = std::max(widest, bounds.hi[k] / 2 - bounds.lo[k] / 2);
  }
  if (widest > 0 && std::isfinite(widest))
    out.scale = std::ldexp(1.0, std::clamp(-std::ilogb(widest) - 1, -1022, 1022));
  return out;
}

SlimCapsule slim(const Capsule& capsule, const Frame& frame) noexcept {
  SlimCapsule out{};
  float size = 0;
  bool is_near = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto from = static_cast<float>((capsule.from[k] - frame.centre[k]) * frame.scale);
    const auto to = static_cast<float>((capsule.to[k] - frame.centre[k]) * frame.scale);
    is_near = is_near && std::abs(from) < 1024 && std::abs(to) < 1024;
    size = std::max(size, std::max(std::abs(from), std::abs(to)));
    out.from[k] = from;
    out.along[k] = to - from;
  }
  // The ends are rounded by less than 2^-21 of the largest coordinate together. The other half of
  // what is added, and the factor, are for the sum and the comparison.
  out.radius = is_near ? static_cast<float>(capsule.radius * frame.scale * (1 + 0x1p-20)) +
                             0x1p-20F * size + 0x1p-100F
                       : std::numeric_limits<float>::infinity();
  return out;
}

std::size_t may_meet(const SlimCapsule* a, const SlimCapsule* b, const std::uint32_t* in_a,
                     const std::uint32_t* in_b, std::size_t n, std::uint32_t* out) noexcept {
  constexpr std::size_t ahead = 3 * width;
  Columns of_a, of_b;
  alignas(32) std::uint32_t keep[width];
  std::size_t n_kept = 0;
  const auto compare_eight = [&](const std::uint32_t* i, const std::uint32_t* j, std::size_t begin,
                                 std::size_t n_used) {
    gather(a, i, of_a);
    gather(b, j, of_b);
    compare(of_a, of_b, keep);
    for (std::size_t l = 0; l < n_used; ++l) {
      out[n_kept] = static_cast<std::uint32_t>(begin + l);
      n_kept += keep[l];
    }
  };
  std::size_t m = 0;
  for (; m + width <= n; m += width) {
    if (m + ahead + width <= n)
      for (std::size_t l = 0; l < width; ++l) {
        __builtin_prefetch(&a[in_a[m + ahead + l]]);
        __builtin_prefetch(&b[in_b[m + ahead + l]]);
      }
    compare_eight(in_a + m, in_b + m, m, width);
  }
  if (m == n) return n_kept;
  // The last ones, completed with the first of them.
  std::array<std::uint32_t, width> i, j;
  for (std::size_t l = 0; l < width; ++l) {
    i[l] = in_a[m + (m + l < n ? l : 0)];
    j[l] = in_b[m + (m + l < n ? l : 0)];
  }
  compare_eight(i.data(), j.data(), m, n - m);
  return n_kept;
}

}  // namespace tess::collide::search
