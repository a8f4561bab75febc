#include "apps/particles/fields.hpp"

#include <algorithm>

namespace particles {
namespace {
using namespace tess::dn;

/// Whether the segment crosses the triangle (Möller and Trumbore 1997), from either side.
bool crosses(Vec3 from, Vec3 to, const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const Vec3 along = to - from, ab = b - a, ac = c - a;
  const Vec3 h = cross(along, ac);
  const double determinant = dot(ab, h);
  if (determinant == 0) return false;
  const Vec3 s = from - a;
  const double u = dot(s, h) / determinant;
  const Vec3 q = cross(s, ab);
  const double v = dot(along, q) / determinant, t = dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t <= 1;
}

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

bool passes_surface(const Object& object, const Surface& surface, Vec3 from, Vec3 to) {
  const Field& field = *object.field;
  const double length = norm(to - from), cell = field.grid.cell;
  if (!std::isfinite(length)) return false;
  const double begin = distance_at(object, from);
  if (begin < HUGE_VAL && std::abs(begin) > length + 2 * cell) return false;
  if (field.sides == Sides::two) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      if (crosses(from, to, surface.corners(t))) return true;
    return false;
  }
  if (begin < -cell) return false;
  // The part of the way that lies in the grid, cut into pieces of half a cell.
  const Vec3 low = field.grid.origin, along = to - from;
  const Vec3 high =
      field.grid.centre(field.grid.n[0] - 1, field.grid.n[1] - 1, field.grid.n[2] - 1);
  double first = 0, last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = component(from, axis), d = component(along, axis);
    if (d == 0) {
      if (a < component(low, axis) || a > component(high, axis)) return false;
      continue;
    }
    const double one = (component(low, axis) - a) / d, other = (component(high, axis) - a) / d;
    first = std::max(first, std::min(one, other));
    last = std::min(last, std::max(one, other));
  }
  if (!(first <= last)) return false;
  const auto pieces =
      static_cast<std::size_t>(std::ceil((last - first) * length / (0.5 * cell))) + 1;
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double t =
        first + (last - first) * (static_cast<double>(i) / static_cast<double>(pieces));
    if (distance_at(object, from + t * along) < -cell) return true;
  }
  return false;
}

}  // namespace particles
