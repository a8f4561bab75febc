#include "apps/particles/audit/passage.hpp"

#include "collide/dn_field/compressed.hpp"

#include <algorithm>

namespace particles {
namespace {
using namespace tess::dn;

/// A direction, to 30 degrees, as a number, and back.
std::uint8_t code_of(Vec3 normal) {
  constexpr double none = 0.38;  // a smaller component of a unit vector counts as 0
  const auto third = [](double part) { return part > none ? 2 : part < -none ? 0 : 1; };
  return static_cast<std::uint8_t>(third(normal.x) + 3 * third(normal.y) + 9 * third(normal.z));
}
Vec3 direction_of(int code) {
  return direction({code % 3 - 1.0, code / 3 % 3 - 1.0, code / 9 - 1.0});
}

/// Follows a particle into the body and out of it. Between two crossings the winding number decides
/// whether the path is inside: faces that lie inside the body, and those that touch, do not count.
Mark after_walls(Mark mark, std::uint16_t number, const Bvh& triangles, Vec3 from, Vec3 to) {
  constexpr double opposite = -0.5;
  constexpr double together = 1e-9;  // part of the path: an edge, or faces that touch
  std::vector<Crossing> crossings;
  triangles.crossings(from, to, crossings);
  if (crossings.empty()) return mark;
  std::ranges::sort(crossings, {}, &Crossing::at);
  const Vec3 way = to - from;
  const auto inside_between = [&](double begin, double end) {
    return triangles.is_inside(from + (0.5 * (begin + end)) * way);
  };
  bool was_inside = inside_between(0, crossings.front().at);
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const double at = crossings[i].at, next = i + 1 < crossings.size() ? crossings[i + 1].at : 1;
    if (i + 1 < crossings.size() && next - at < together) continue;
    const bool inside = inside_between(at, next);
    const Vec3 normal = triangles.normal(crossings[i].triangle);
    if (!was_inside && !inside && mark.what != Mark::inside) mark.what = Mark::through;  // a sheet
    if (!was_inside && inside) mark = {Mark::inside, code_of(normal), number};
    if (was_inside && !inside && mark.what == Mark::inside && mark.object == number) {
      const bool passed = dot(direction_of(mark.looks), normal) < opposite;
      mark = {passed ? Mark::through : Mark::nothing, 0, number};
    }
    if (mark.what == Mark::through) break;
    was_inside = inside;
  }
  return mark;
}

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

double greatest_depth(const Rules& rules) {
  return rules.impact && look_up_of(rules) == LookUp::nearest ? 2 : 1;
}

Mark mark_after(Mark mark, const Audited& audited, Vec3 from, Vec3 to) {
  const auto& [number, object, depth] = audited;
  const Bvh* const triangles = object.triangles;
  const Mark through{Mark::through, 0, number};
  const Field& field = *object.field;
  const double length = norm(to - from);
  if (mark.what == Mark::through || !std::isfinite(length)) return mark;
  const double begin = distance_at(object, from);
  if (begin < HUGE_VAL && std::abs(begin) > length + (depth + 1) * field.grid.cell) return mark;
  if (field.sides == Sides::two) {
    std::vector<Crossing> crossings;
    triangles->crossings(from, to, crossings);
    return crossings.empty() ? mark : through;
  }
  if (goes_below(object, depth * field.grid.cell, begin, from, to)) return through;
  return triangles != nullptr ? after_walls(mark, number, *triangles, from, to) : mark;
}

}  // namespace particles
