#include "apps/collide_scene/scenes/elementary.hpp"
#include "apps/collide_scene/scenes/kinds.hpp"
#include "runtime/core/hash.hpp"

#include <cmath>
#include <fmt/core.h>

namespace collide_scene {
namespace {

using tess::collide::dot;
using tess::collide::Point;

/// Uniform over all directions.
Point random_direction(tess::Random& random) {
  for (;;) {
    Point d{};
    for (double& x : d) x = 2 * random.unit() - 1;
    const double length2 = dot(d, d);
    if (length2 > 1 || length2 < 1e-3) continue;
    for (double& x : d) x /= std::sqrt(length2);
    return d;
  }
}

/// The length and the width are those at 100 000 triangles.
Scene triangles(std::uint64_t n, std::uint64_t seed, double length, double width) {
  const double scale = cube_root(1e5 / static_cast<double>(n));
  length *= scale;
  width *= scale;
  Scene scene;
  scene.description =
      fmt::format("{} random triangles, {:.4g} long and {:.4g} wide", n, length, width);
  tess::Random random(seed);
  scene.triangles.reserve(n);
  for (std::uint64_t i = 0; i < n; ++i) {
    Point at{}, end{}, side{};
    for (double& x : at) x = random.unit();
    const Point along = random_direction(random), aside = random_direction(random);
    for (std::size_t k = 0; k < 3; ++k) {
      end[k] = at[k] + length * along[k];
      side[k] = at[k] + width * aside[k];
    }
    scene.triangles.push_back({{at, end, side}});
  }
  return scene;
}

}  // namespace

Scene needles(std::uint64_t n, std::uint64_t seed) {
  return triangles(n, seed, 0.1, 1e-4);
}
Scene long_needles(std::uint64_t n, std::uint64_t seed) {
  return triangles(n, seed, 0.2, 1e-4);
}
Scene short_triangles(std::uint64_t n, std::uint64_t seed) {
  return triangles(n, seed, 0.02, 0.02);
}

}  // namespace collide_scene
