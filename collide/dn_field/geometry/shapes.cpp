#include "collide/dn_field/shapes.hpp"

#include <numbers>

namespace tess::dn {
namespace {

void add_quad(Surface& surface, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  if (a != b && b != c && a != c) surface.triangles.push_back({a, b, c});
  if (a != c && c != d && a != d) surface.triangles.push_back({a, c, d});
}

}  // namespace

Surface make_box(Vec3 half) {
  Surface box;
  for (unsigned i = 0; i < 8; ++i)
    box.vertices.push_back({(i & 1U) != 0 ? half.x : -half.x, (i & 2U) != 0 ? half.y : -half.y,
                            (i & 4U) != 0 ? half.z : -half.z});
  add_quad(box, 0, 2, 3, 1);
  add_quad(box, 4, 5, 7, 6);
  add_quad(box, 0, 1, 5, 4);
  add_quad(box, 2, 6, 7, 3);
  add_quad(box, 0, 4, 6, 2);
  add_quad(box, 1, 3, 7, 5);
  return box;
}

Surface make_sphere(double radius, int rings) {
  Surface sphere;
  const auto n = static_cast<std::uint32_t>(rings);
  const std::uint32_t around = 2 * n;
  sphere.vertices.push_back({0, 0, -radius});
  for (std::uint32_t i = 1; i < n; ++i)
    for (std::uint32_t j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / n, azimuth = 2 * std::numbers::pi * j / around;
      sphere.vertices.push_back({radius * std::sin(polar) * std::cos(azimuth),
                                 radius * std::sin(polar) * std::sin(azimuth),
                                 -radius * std::cos(polar)});
    }
  sphere.vertices.push_back({0, 0, radius});
  const auto last = static_cast<std::uint32_t>(sphere.vertices.size() - 1);
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return i == 0 ? 0 : i == n ? last : 1 + (i - 1) * around + j % around;
  };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < around; ++j)
      add_quad(sphere, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
  return sphere;
}

Surface make_torus(double major_radius, double minor_radius, int count) {
  Surface torus;
  const auto n = static_cast<std::uint32_t>(count);
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / n;
      const double r = major_radius + minor_radius * std::cos(v);
      torus.vertices.push_back({r * std::cos(u), r * std::sin(u), minor_radius * std::sin(v)});
    }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return (i % n) * n + j % n; };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j)
      add_quad(torus, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return torus;
}

Surface make_plate(double half, int count) {
  Surface plate;
  const auto n = static_cast<std::uint32_t>(count);
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      plate.vertices.push_back({half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), 0});
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (n + 1) + i; };
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i)
      add_quad(plate, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return plate;
}

}  // namespace tess::dn
