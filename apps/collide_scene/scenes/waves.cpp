#include "apps/collide_scene/scenes/elementary.hpp"
#include "apps/collide_scene/scenes/kinds.hpp"

#include <fmt/core.h>

namespace collide_scene {
namespace {

using tess::collide::Point;
using tess::collide::Triangle;

constexpr Point kShift{0.3, 0.3, 0.2};

std::uint64_t row_of_quads(std::uint64_t n) {
  std::uint64_t quads = 1;
  while (8 * quads * quads <= n) quads *= 2;
  return quads;
}

/// `placed`: the corner of the plane's point (x, y, z) in the scene.
template <class Placed>
void add_plane(Scene& scene, std::uint64_t n, std::uint32_t model, Placed&& placed) {
  const std::uint64_t row = row_of_quads(n);
  const auto at = [&](std::uint64_t i, std::uint64_t j) {
    const auto x = static_cast<double>(i), y = static_cast<double>(j);
    return placed(Point{x, y, 4 * sine(x / 32) * cosine(y / 32)});
  };
  for (std::uint64_t k = 0; k < n; ++k) {
    const std::uint64_t i = k / 2 % row, j = k / 2 / row;
    const Point b = at(i + 1, j), d = at(i, j + 1);
    scene.triangles.push_back(k % 2 == 0 ? Triangle{{at(i, j), b, d}}
                                         : Triangle{{b, at(i + 1, j + 1), d}});
  }
  scene.models.insert(scene.models.end(), n, model);
}

Point shifted(const Point& p) {
  return {p[0] + kShift[0], p[1] + kShift[1], p[2] + kShift[2]};
}
Point unmoved(const Point& p) {
  return p;
}

}  // namespace

Scene wave(std::uint64_t n) {
  Scene scene;
  scene.description = fmt::format("{} triangles of a wavy plane", n);
  scene.triangles.reserve(n);
  add_plane(scene, n, 0, unmoved);
  return scene;
}

Scene two_planes(std::uint64_t n) {
  Scene scene;
  scene.description = fmt::format("{} triangles in two near-parallel wavy planes", n);
  scene.triangles.reserve(n);
  add_plane(scene, n - n / 2, 0, unmoved);
  add_plane(scene, n / 2, 1, shifted);
  return scene;
}

Scene crossing_planes(std::uint64_t n) {
  Scene scene;
  scene.description = fmt::format("{} triangles in two wavy planes that cross", n);
  scene.triangles.reserve(n);
  add_plane(scene, n - n / 2, 0, unmoved);
  const auto rows = static_cast<double>(n / 4 / row_of_quads(n / 2));
  add_plane(scene, n / 2, 1, [&](const Point& p) {
    return shifted({p[0], rows / 2 - p[2], p[1] - rows / 2});
  });
  return scene;
}

}  // namespace collide_scene
