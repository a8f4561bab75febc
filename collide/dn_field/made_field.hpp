// Fields from formulas, with exact distances: for the stability report, tests and benchmarks.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/normal_code.hpp"

namespace tess::dn {

/// The value of a formula at one point.
struct DistanceNormal {
  double distance = 0;
  Vec3 normal;
};

/// formula: DistanceNormal(Vec3), evaluated at every voxel's centre.
template <class Formula>
[[nodiscard]] Field made_field(const Grid& grid, const Formula& formula) {
  Field field;
  field.grid = grid;
  field.thickness = HUGE_VAL;
  field.distance.reserve(grid.size());
  field.normal.reserve(grid.size());
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const DistanceNormal here = formula(grid.centre(i, j, k));
        field.distance.push_back(static_cast<float>(here.distance));
        field.normal.push_back(encode_normal(here.normal));
      }
  field.jump = greatest_jump(field);
  return field;
}

/// n³ voxels over the cube |x|, |y|, |z| <= half.
[[nodiscard]] inline Grid cube_grid(double half, int n) {
  return {{-half, -half, -half}, 2 * half / (n - 1), {n, n, n}};
}

/// The half space below the plane through the origin with this unit normal.
[[nodiscard]] inline Field plane_field(const Grid& grid, Vec3 normal) {
  return made_field(grid, [&](Vec3 p) { return DistanceNormal{dot(normal, p), normal}; });
}

/// The open surface z = 0, met from either side.
[[nodiscard]] inline Field sheet_field(const Grid& grid) {
  Field field = made_field(grid, [](Vec3 p) {
    return DistanceNormal{std::abs(p.z), {0, 0, p.z < 0 ? -1.0 : 1.0}};
  });
  field.sides = Sides::two;
  return field;
}

[[nodiscard]] inline Field sphere_field(const Grid& grid, double radius) {
  return made_field(grid, [&](Vec3 p) { return DistanceNormal{norm(p) - radius, direction(p)}; });
}

/// The inside of the cube |x|, |y|, |z| <= half.
[[nodiscard]] inline Field room_field(const Grid& grid, double half) {
  return made_field(grid, [&](Vec3 p) {
    const Vec3 a{std::abs(p.x), std::abs(p.y), std::abs(p.z)};
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const double side = component(p, axis) > 0 ? -1 : 1;
    return DistanceNormal{
        half - component(a, axis),
        side * Vec3{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}};
  });
}

}  // namespace tess::dn
