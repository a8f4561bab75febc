#include "apps/collide_scene/scenes/kinds.hpp"

#include <cmath>
#include <fmt/core.h>

namespace collide_scene {

using tess::collide::Point;

Scene nested_ls(std::uint64_t n) {
  Scene scene;
  scene.description = fmt::format("{} nested L shapes of four triangles each", n);
  scene.triangles.reserve(4 * n);
  scene.models.reserve(4 * n);
  // The arms go to (±1, 0.6, 0.8), at a right angle. A power of two keeps the corners exact.
  double apart = 0.25;
  while (apart * static_cast<double>(n) > 0.25) apart /= 2;
  const double thick = apart / 2;
  for (std::uint64_t k = 0; k < n; ++k) {
    const double up = static_cast<double>(k) * apart;
    const Point corner{0, up, up}, inner{0, up + thick, up};
    for (const double side : {-1.0, 1.0}) {
      const Point tip{side, 0.6 + up, 0.8 + up}, inner_tip{side, 0.6 + up + thick, 0.8 + up};
      scene.triangles.push_back({{corner, tip, inner}});
      scene.triangles.push_back({{tip, inner_tip, inner}});
    }
    scene.models.insert(scene.models.end(), 4, static_cast<std::uint32_t>(k));
  }
  return scene;
}

Scene crossing_segments(std::uint64_t n) {
  const std::uint64_t n_x = n - n / 2, n_y = n / 2;
  Scene scene;
  scene.description = fmt::format("{} thin triangles, {} crossings", n, n_x * n_y);
  scene.triangles.reserve(n);
  // Those along x stand upright, those along y lie flat at half their height or below.
  for (std::uint64_t i = 0; i < n_x; ++i) {
    const double y = static_cast<double>(i) / static_cast<double>(n_x), h = 0x1p-10;
    scene.triangles.push_back({{Point{-1, y, -h}, Point{2, y, -h}, Point{0.5, y, 2 * h}}});
  }
  for (std::uint64_t i = 0; i < n_y; ++i) {
    const double step = 1 / static_cast<double>(n_y), x = static_cast<double>(i) * step;
    scene.triangles.push_back({{Point{x, -1, 0}, Point{x + step / 4, -1, 0}, Point{x, 2, 0}}});
  }
  for (std::uint64_t i = 0; i < n; ++i) scene.models.push_back(static_cast<std::uint32_t>(i));
  return scene;
}

}  // namespace collide_scene
