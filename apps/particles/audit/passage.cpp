#include "apps/particles/audit/passage.hpp"

#include "collide/dn_field/compressed.hpp"

#include <algorithm>

namespace particles {
namespace {
using namespace tess::dn;

/// Whether a path that begins at the distance `begin`, above −depth, reaches below −depth.
bool goes_below(const Object& object, double depth, double begin, Vec3 from, Vec3 to) {
  const Field& field = *object.field;
  const double length = norm(to - from), cell = field.grid.cell;
  if (begin < -depth) return false;
  // The part of the path that lies in the grid, cut into pieces of half a cell.
  const auto [enters, leaves] = field.grid.box().part_of_line(from, to - from);
  const double first = std::max(0.0, enters), last = std::min(1.0, leaves);
  if (!(first <= last)) return false;
  const auto pieces =
      static_cast<std::size_t>(std::ceil((last - first) * length / (0.5 * cell))) + 1;
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double t =
        first + (last - first) * (static_cast<double>(i) / static_cast<double>(pieces));
    if (distance_at(object, from + t * (to - from)) < -depth) return true;
  }
  return false;
}

}  // namespace

double distance_at(const tess::dn::Object& object, tess::dn::Vec3 p) {
  const Grid& grid = object.field->grid;
  const auto voxel = [&](int i, int j, int k) {
    return static_cast<double>(voxel_distance(*object.field, i, j, k));
  };
  std::array<int, 3> low{};
  std::array<double, 3> part{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis), last = grid.n[axis] - 1;
    const double at = (component(p, a) - component(grid.origin, a)) / grid.cell;
    if (last < 1 || !(at >= 0 && at <= last)) return HUGE_VAL;
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

double greatest_depth(const Rules& rules) {
  return rules.impact && rules.look_up == LookUp::nearest ? 2 : 1;
}

bool leads_through(const Audited& audited, Vec3 from, Vec3 to) {
  const auto& [object, triangles, depth] = audited;
  const Field& field = *object.field;
  const double length = norm(to - from), begin = distance_at(object, from);
  if (!std::isfinite(length)) return false;
  if (begin < HUGE_VAL && std::abs(begin) > length + (depth + 1) * field.grid.cell) return false;
  if (field.sides == Sides::one)
    return goes_below(object, depth * field.grid.cell, begin, from, to);
  std::vector<Crossing> crossings;
  triangles->crossings(from, to, crossings);
  return !crossings.empty();
}

}  // namespace particles
