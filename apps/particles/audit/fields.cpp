#include "apps/particles/audit/fields.hpp"

#include <algorithm>

namespace particles {
namespace {
using namespace tess::dn;

/// Interpolated between the voxels of a grid; value: double(int i, int j, int k).
template <class Value>
double interpolated(const Grid& grid, const Value& value, Vec3 p) {
  std::array<int, 3> low{};
  std::array<double, 3> part{};
  for (int axis = 0; axis < 3; ++axis) {
    const double at = (component(p, axis) - component(grid.origin, axis)) / grid.cell;
    const int last = grid.n[static_cast<std::size_t>(axis)] - 1;
    if (!(at >= 0 && at <= last)) return HUGE_VAL;
    const double floor = std::min(std::floor(at), last - 1.0);
    low[static_cast<std::size_t>(axis)] = static_cast<int>(floor);
    part[static_cast<std::size_t>(axis)] = at - floor;
  }
  const auto along_x = [&](int j, int k) {
    return (1 - part[0]) * value(low[0], low[1] + j, low[2] + k) +
           part[0] * value(low[0] + 1, low[1] + j, low[2] + k);
  };
  const auto in_plane = [&](int k) {
    return (1 - part[1]) * along_x(0, k) + part[1] * along_x(1, k);
  };
  return (1 - part[2]) * in_plane(0) + part[2] * in_plane(1);
}

}  // namespace

double distance_at(const Field& field, Vec3 p) {
  const auto value = [&field](int i, int j, int k) {
    return static_cast<double>(field.distance[field.grid.index(i, j, k)]);
  };
  return interpolated(field.grid, value, p);
}

double distance_at(const Object& object, Vec3 p) {
  if (object.compressed == nullptr) return distance_at(*object.field, p);
  const auto value = [&object](int i, int j, int k) {
    return static_cast<double>(voxel_distance(*object.compressed, i, j, k));
  };
  return interpolated(object.field->grid, value, p);
}

}  // namespace particles
