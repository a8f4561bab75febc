// The stability report's extreme places and fields: starts inside and on the surface, scales,
// offsets, compressed and blurred fields, particles that are not finite.
#include "apps/particles/stability/cases.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/shapes.hpp"

#include <algorithm>

namespace tess::dn::stability {
namespace {

Vec3 some_direction(int i) {
  return direction({std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i + 1)});
}

void starts(Rows& rows) {
  const Field ball = sphere_field(cube_grid(2, 41), 1);
  const Object object{&ball, {}};
  for (const double depth : {0.0, 1e-9, 1e-3, 0.1, 0.5, 0.9}) {
    double gain = 0, inside = 0;
    for (int i = 0; i < 20; ++i) {
      const Vec3 from = some_direction(i);
      const Vec3 velocity = 0.3 * direction({std::cos(5.0 * i), std::sin(7.0 * i), 0.2});
      const Particle end =
          flown(impact(1, Sweep::on), 0.02, 20, {&object, 1}, {(1 - depth) * from, velocity});
      worsen(gain, norm(end.velocity) / 0.3 - 1);
      worsen(inside, 1 - norm(end.position));
    }
    rows.add("start inside: gain of |v|", "depth", depth, gain, 1e-13);
    rows.add("start inside: still inside by", "depth", depth, inside, 3e-3 * ball.grid.cell / 0.05);
  }
}

/// The same bounce, scaled and shifted.
void scales(Rows& rows) {
  const Field ball = sphere_field(cube_grid(2, 41), 1);
  const Object object{&ball, {}};
  const Particle start{{1.5, 0.3, 0.2}, {-1, 0.1, 0}};
  const Particle plain = flown(impact(1, Sweep::on), 0.05, 20, {&object, 1}, start);
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    Object scaled{&ball, {}};
    scaled.frame.scale = scale;
    const Particle end = flown(impact(1, Sweep::on), 0.05, 20, {&scaled, 1},
                               {scale * start.position, scale * start.velocity});
    rows.add("scale", "scale", scale, norm((1 / scale) * end.position - plain.position), 1e-5);
    rows.add("scale: |v|", "scale", scale,
             std::abs(norm(end.velocity) / (scale * norm(start.velocity)) - 1), 1e-13);
  }
  for (const double offset : {1e3, 1e6, 1e9}) {
    const Vec3 shift = offset * Vec3{1, -1, 1};
    Object shifted{&ball, {}};
    shifted.frame.position = shift;
    const Particle end = flown(impact(1, Sweep::on), 0.05, 20, {&shifted, 1},
                               {shift + start.position, start.velocity});
    rows.add("offset", "offset", offset, norm(end.position - shift - plain.position),
             1e-5 + 1e-14 * offset);
    rows.add("offset: |v|", "offset", offset,
             std::abs(norm(end.velocity) / norm(start.velocity) - 1), 1e-13);
  }
}

/// Head-on bounces off a ball of radius 0.5 from distance 1.5 at speed 1, for time 2.
template <class Visit>
void bounce_off_ball(const Object& object, const Visit& visit) {
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = some_direction(i);
    visit(from, flown(impact(1, Sweep::on), 0.05, 40, {&object, 1}, {1.5 * from, -from}));
  }
}

/// The bounce off a compressed field is off by its error bounds, and keeps the speed.
void compressed_fields(Rows& rows) {
  Field ball = sphere_field(cube_grid(1, 41), 0.5);
  ball.thickness = 1.3;
  for (const double cells : {1e-2, 1e-1, 1.0}) {
    const ErrorBound bound{cells * ball.grid.cell, cells};
    const Field compressed = compress(ball, bound);
    double place = 0, changed = 0;
    bounce_off_ball({&compressed, {}}, [&](Vec3 from, Particle end) {
      worsen(place, norm(end.position - 1.5 * from));
      worsen(changed, std::abs(norm(end.velocity) - 1));
    });
    // The flat field's share is half a voxel's diagonal over the radius, in the normal.
    rows.add("compressed field: place", "bound, cells", cells, place,
             2 * bound.distance + 2 * (bound.angle + std::sqrt(3.0) * ball.grid.cell));
    rows.add("compressed field: |v|", "bound, cells", cells, changed, 1e-12);
  }
}

/// The number of points on a way through a thin plate at which its flat field has a normal and the
/// compressed one has none: wherever the plate lies between the cells, none.
void compressed_plates(Rows& rows) {
  const Surface plate = make_plate(1, 1);
  constexpr std::size_t n_points = 1000;
  std::vector<float> x(n_points, 0.03F), y(n_points, 0.07F), z(n_points);
  for (std::size_t p = 0; p < n_points; ++p)
    z[p] = 0.25F * (2 * static_cast<float>(p) / n_points - 1);
  const auto normals = [&](const Field& field) {
    std::vector<float> nx(n_points), ny(n_points), nz(n_points);
    look_up(field, LookUp::nearest, {x, y, z}, {{}, nx, ny, nz});
    return nz;
  };
  for (const int n : {21, 22, 24, 26, 30, 38}) {
    const Grid grid = grid_around(bounds(plate), n, 0.3);
    const Field flat = build_field(plate, grid, {.sides = Sides::two, .thickness = 0.3});
    const Field compressed = compress(flat, {0.2 * grid.cell, 0.14});
    const std::vector<float> before = normals(flat), after = normals(compressed);
    double n_kept = 0, n_lost = 0;
    for (std::size_t p = 0; p < n_points; ++p)
      if (before[p] != 0) ++(after[p] != 0 ? n_kept : n_lost);
    rows.add("compressed plate: lost normals", "voxels", n, n_kept > 0 ? n_lost : n_points, 0);
  }
}

/// Normals of blurred fields differ from the surface's; the reflected direction by twice as much.
void blurred_fields(Rows& rows) {
  const Surface surface = make_sphere(0.5, 40);
  const Grid grid = grid_around(bounds(surface), 41, 0.25);
  for (const Method method : {Method::normals, Method::potential}) {
    const Field field = build_field(surface, grid, {.thickness = 0.25, .method = method});
    double angle = 0, changed = 0;
    bounce_off_ball({&field, {}}, [&](Vec3 from, Particle end) {
      worsen(angle, std::acos(std::min(dot(direction(end.velocity), from), 1.0)));
      worsen(changed, std::abs(norm(end.velocity) - 1));
    });
    const bool by_normals = method == Method::normals;
    const std::string name = by_normals ? "blurred by normals" : "blurred by potential";
    constexpr double degree = 3.14159265358979323846 / 180;
    rows.add(name + ": angle", "cells", grid.n[0], angle, 2 * (by_normals ? 6 : 8) * degree);
    rows.add(name + ": |v|", "cells", grid.n[0], changed, 1e-12);
  }
}

/// Particles that are not finite do not affect the others.
void not_finite(Rows& rows) {
  const Field ball = sphere_field(cube_grid(2, 17), 1);
  const Object object{&ball, {}};
  Rules rules = impact(1, Sweep::on);
  rules.spring = Spring{100, 1, 0.1};
  rules.surface_drag = SurfaceDrag{1, 0.2};
  rules.surface_flow = SurfaceFlow{1, 1, 0.3};
  rules.gravity = Gravity{{0, 0, -1}};
  const Stepper stepper = make_stepper(rules, 0.01);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    Particles with, without;
    for (int i = 0; i < 16; ++i) {
      const Vec3 x{1.2 * std::sin(1.0 * i), 1.2 * std::cos(1.0 * i), 0.1 * i}, v{0, 0, -1};
      without.push_back(x, v);
      with.push_back(i == 3 ? Vec3{bad, 0, 0} : x, i == 5 ? Vec3{0, bad, 0} : v);
    }
    stepper.run(with.span(), {&object, 1}, 0, 50);
    stepper.run(without.span(), {&object, 1}, 0, 50);
    double different = 0;
    for (std::size_t p = 0; p < 16; ++p)
      if (p != 3 && p != 5)
        different +=
            with.position(p) == without.position(p) && with.velocity(p) == without.velocity(p) ? 0
                                                                                               : 1;
    rows.add("not finite: others changed", "value", bad, different, 0);
  }
}

}  // namespace

void extreme_places(Rows& rows) {
  starts(rows);
  scales(rows);
  compressed_fields(rows);
  compressed_plates(rows);
  blurred_fields(rows);
  not_finite(rows);
}

}  // namespace tess::dn::stability
