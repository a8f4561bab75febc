#include "apps/particles/audit/fields.hpp"

#include "collide/dn_field/compressed.hpp"

#include <algorithm>

namespace particles {

using namespace tess::dn;

double distance_at(const Object& object, Vec3 p) {
  const Grid& grid = object.field->grid;
  const auto voxel = [&](int i, int j, int k) {
    return static_cast<double>(object.compressed != nullptr
                                   ? voxel_distance(*object.compressed, i, j, k)
                                   : object.field->distance[grid.index(i, j, k)]);
  };
  std::array<int, 3> low{};
  std::array<double, 3> part{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis), last = grid.n[axis] - 1;
    const double at = (component(p, a) - component(grid.origin, a)) / grid.cell;
    if (!(at >= 0 && at <= last)) return HUGE_VAL;
    low[axis] = static_cast<int>(std::min(std::floor(at), last - 1.0));
    part[axis] = at - low[axis];
  }
  const auto between = [](double t, double a, double b) { return (1 - t) * a + t * b; };
  const auto along_x = [&](int j, int k) {
    return between(part[0], voxel(low[0], low[1] + j, low[2] + k),
                   voxel(low[0] + 1, low[1] + j, low[2] + k));
  };
  return between(part[2], between(part[1], along_x(0, 0), along_x(1, 0)),
                 between(part[1], along_x(0, 1), along_x(1, 1)));
}

}  // namespace particles
