#include "apps/collide_scene/scenes/elementary.hpp"
#include "apps/collide_scene/scenes/kinds.hpp"
#include "runtime/core/hash.hpp"

#include <fmt/core.h>

namespace collide_scene {
namespace {

using tess::collide::Aabb;

/// `extent(axis)`: of the next box; called for the axes in order.
template <class Extent>
void add_boxes(Scene& scene, std::uint64_t n, tess::Random& random, Extent&& extent) {
  scene.boxes.reserve(n);
  for (std::uint64_t i = 0; i < n; ++i) {
    Aabb box{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = extent(k);
      box.lo[k] = (1 - length) * random.unit();
      box.hi[k] = box.lo[k] + length;
    }
    scene.boxes.push_back(box);
  }
}

/// A length that keeps the pairs per object at any n.
double scaled(double at_a_million, std::uint64_t n) {
  return at_a_million * cube_root(1e6 / static_cast<double>(n));
}

/// Two cubes overlap with the probability E[(a + b)³]. For edges log-uniform over many decades up
/// to L that is about L³ (2 / 3q + 3 / q²), where q is the logarithm of the ratio of sizes.
Scene log_uniform(std::uint64_t n, std::uint64_t seed, int decades, double largest) {
  constexpr double log2_of_10 = 3.321928094887362;
  Scene scene;
  scene.description = fmt::format("{} random cubes with sizes over {} decades, the largest {:.4g}",
                                  n, decades, largest);
  tess::Random random(seed);
  double edge = 0;
  add_boxes(scene, n, random, [&](std::size_t axis) {
    if (axis == 0) edge = largest * power_of_two(-decades * log2_of_10 * random.unit());
    return edge;
  });
  return scene;
}

}  // namespace

Scene random_boxes(std::uint64_t n, std::uint64_t seed) {
  const double largest = scaled(0.019, n);
  Scene scene;
  scene.description = fmt::format("{} random boxes with extents up to {:.4g}", n, largest);
  tess::Random random(seed);
  add_boxes(scene, n, random, [&](std::size_t) { return largest * random.unit(); });
  return scene;
}

Scene four_decades(std::uint64_t n, std::uint64_t seed) {
  return log_uniform(n, seed, 4, scaled(0.0556, n));
}
Scene six_decades(std::uint64_t n, std::uint64_t seed) {
  return log_uniform(n, seed, 6, scaled(0.0662, n));
}

}  // namespace collide_scene
