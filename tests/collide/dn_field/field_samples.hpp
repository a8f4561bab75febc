// What the tests of the field's construction share: all voxels of a grid, meshes that are not
// whole, trilinear sampling, and the text of a refusal.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "collide/dn_field/surface.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <numbers>
#include <random>
#include <string>

namespace tess::dn::test {

inline constexpr double degree = std::numbers::pi / 180;

template <class Visit>
void for_each_voxel(const Grid& grid, const Visit& visit) {
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) visit(grid.index(i, j, k), grid.centre(i, j, k));
}

using tess::test::message_of;

inline Vec3 decoded(std::uint32_t code) {
  const Normal n = decode_normal(code);
  return {static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)};
}

/// Angle between unit vectors, in radians; exact for small ones.
inline double angle_between(Vec3 a, Vec3 b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

inline Surface without_last(Surface surface, std::size_t n_triangles) {
  surface.triangles.resize(surface.triangles.size() - n_triangles);
  return surface;
}

inline Surface with_flipped(Surface surface, std::size_t every) {
  for (std::size_t t = 0; t < surface.triangles.size(); t += every)
    std::swap(surface.triangles[t][0], surface.triangles[t][1]);
  return surface;
}

/// Each triangle with corners of its own, moved by up to `crack`: nothing fits together.
inline Surface torn(const Surface& surface, double crack) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> move(-crack, crack);
  Surface soup;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const Vec3 p : surface.corners(t))
      soup.vertices.push_back(p + Vec3{move(random), move(random), move(random)});
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// `n` triangles of all sizes, some of them lines or points.
inline Surface random_triangles(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(-1, 1), exponent(-4, 0);
  Surface surface;
  for (std::size_t t = 0; t < n; ++t) {
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    const Vec3 a{at(random), at(random), at(random)};
    const double size = std::pow(10, exponent(random));
    const Vec3 b = a + size * Vec3{at(random), at(random), at(random)};
    const Vec3 c = t % 7 == 0   ? a
                   : t % 7 == 1 ? a + 0.3 * (b - a)
                   : t % 7 == 2 ? a + 0.7 * (b - a) + Vec3{1e-12, 0, 0}
                                : a + size * Vec3{at(random), at(random), at(random)};
    for (const Vec3 p : {a, b, t % 14 == 0 ? a : c}) surface.vertices.push_back(p);
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

/// The distance at `p`, interpolated between the eight voxels around it.
inline double trilinear(const Field& field, Vec3 p) {
  const Vec3 g = (1 / field.grid.cell) * (p - field.grid.origin);
  const int i = static_cast<int>(std::floor(g.x)), j = static_cast<int>(std::floor(g.y)),
            k = static_cast<int>(std::floor(g.z));
  const double u = g.x - i, v = g.y - j, w = g.z - k;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
    sum += (di != 0 ? u : 1 - u) * (dj != 0 ? v : 1 - v) * (dk != 0 ? w : 1 - w) *
           static_cast<double>(field.distance[field.grid.index(i + di, j + dj, k + dk)]);
  }
  return sum;
}

}  // namespace tess::dn::test
