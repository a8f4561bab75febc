#include "apps/collide_scene/scenes/elementary.hpp"
#include "apps/collide_scene/scenes/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace collide_scene {
namespace {

using tess::collide::cross;
using tess::collide::dot;
using tess::collide::Point;

/// The tube is about 14 times as long as it is round.
constexpr double kLengthToGirth = 14;

/// The knot lies on a torus with radii 2 and 1: three times around the tube of the torus while it
/// goes twice around the hole. Its normal on the torus, and the tangent, give a frame that closes.
Point on_tube(double along, double around) {
  const double c = cosine(3 * along), s = sine(3 * along);
  const double x = cosine(2 * along), y = sine(2 * along);
  const Point centre{(2 + c) * x, (2 + c) * y, s}, normal{c * x, c * y, s};
  const Point tangent{-3 * s * x - 2 * (2 + c) * y, -3 * s * y + 2 * (2 + c) * x, 3 * c};
  Point side = cross(tangent, normal);
  const double length = std::sqrt(dot(side, side));
  const double radius = 0.35 * (1 + 0.2 * sine(37 * along) * cosine(5 * around) +
                                0.06 * sine(211 * along + 3 * around));
  Point out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = centre[k] + radius * (cosine(around) * normal[k] + sine(around) * side[k] / length);
  return out;
}

}  // namespace

Scene dragon(std::uint64_t n) {
  const auto n_around = std::max<std::uint64_t>(
      3, static_cast<std::uint64_t>(std::sqrt(static_cast<double>(n) / (2 * kLengthToGirth))));
  const auto n_along = std::max<std::uint64_t>(4, n / (2 * n_around));
  std::vector<Point> points;
  points.reserve(n_along * n_around);
  for (std::uint64_t i = 0; i < n_along; ++i)
    for (std::uint64_t j = 0; j < n_around; ++j)
      points.push_back(on_tube(static_cast<double>(i) / static_cast<double>(n_along),
                               static_cast<double>(j) / static_cast<double>(n_around)));
  Scene scene;
  scene.triangles.reserve(2 * points.size());
  for (std::uint64_t i = 0; i < n_along; ++i)
    for (std::uint64_t j = 0; j < n_around; ++j) {
      const auto at = [&](std::uint64_t di, std::uint64_t dj) {
        return points[(i + di) % n_along * n_around + (j + dj) % n_around];
      };
      scene.triangles.push_back({{at(0, 0), at(1, 0), at(0, 1)}});
      scene.triangles.push_back({{at(1, 0), at(1, 1), at(0, 1)}});
    }
  scene.models.assign(scene.triangles.size(), 0);
  scene.description =
      fmt::format("{} triangles of a bumpy tube around a knot", scene.triangles.size());
  return scene;
}

}  // namespace collide_scene
