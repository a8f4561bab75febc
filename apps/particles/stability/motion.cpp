// The stability report's extreme motions: speed, spin, moving walls, corners, rest, all rules at
// once.
#include "apps/particles/stability/cases.hpp"

#include <algorithm>

namespace tess::dn::stability {
namespace {

double total_speed_error(Particle particle, double speed) {
  return std::abs(norm(particle.velocity) / speed - 1);
}

/// Particles shot from outside the fields at an open surface and at a ball: the rows count those
/// that end on the wrong side. From a displacement of two thicknesses a step on, only a sweep along
/// the path finds the surface.
void fast(Rows& rows) {
  constexpr double thickness = 0.3;
  const Field sheet = sheet_field(cube_grid(thickness, 17));
  const Field ball = sphere_field(cube_grid(0.5 + thickness, 33), 0.5);
  for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
    for (const double thicknesses : {1e-1, 1e0, 1e1, 1e2, 1e4, 1e6, 1e18, 1e22, 1e30, 1e45, 1e99}) {
      const double speed = thickness * thicknesses;  // a step
      const Rules rules = impact(1, Sweep::on, look_up);
      const int n_steps = static_cast<int>(std::ceil(4 / speed)) + 1;
      double tunnelled = 0, changed = 0;
      const auto shoot = [&](const Field& field, Particle start, Vec3 outward) {
        const Object object{&field, {}};
        const Particle end = flown(rules, 1, n_steps, {&object, 1}, start);
        tunnelled += dot(end.position, outward) > 0 && dot(end.velocity, outward) > 0 ? 0 : 1;
        worsen(changed, total_speed_error(end, speed));
      };
      for (int i = 0; i < 40; ++i) {
        const Vec3 side{0, 0, i % 2 == 0 ? 1.0 : -1.0}, aim{0.01 * i - 0.2, 0.1 - 0.005 * i, 0};
        const Vec3 way = direction({0.2 - 0.01 * i, 0.1, -2 * side.z});
        shoot(sheet, {aim - (1.5 + 0.013 * i) * way, speed * way}, side);
        const Vec3 from = direction({std::cos(1.0 * i), std::sin(1.0 * i), 0.1 * i - 2});
        shoot(ball, {(1.9 + 0.017 * i) * from, -speed * from}, from);
      }
      const std::string name = std::string("fast, ") + name_of(look_up);
      rows.add(name + ": tunnelled", "v dt/thickness", thicknesses, tunnelled, 0);
      rows.add(name + ": |v|", "v dt/thickness", thicknesses, changed, 1e-12);
    }
}

void grazing(Rows& rows) {
  const Field ball = sphere_field(cube_grid(2, 33), 0.5);
  const Object object{&ball, {}};
  for (const double slope : {1e-1, 1e-3, 1e-6, 1e-9, 0.0}) {
    const Particle start{{-1.5, 0.5 - 1.5 * slope, 0.01}, {1, slope, 0}};
    const Particle end = flown(impact(1, Sweep::on), 0.05, 60, {&object, 1}, start);
    const double speed = norm(start.velocity);
    rows.add("grazing: |v|", "slope", slope, total_speed_error(end, speed), 1e-13);
  }
}

/// Parallel particles that a threshold stops before a ball: those beside it fly on, the others leave
/// by its normal, which a voxel knows up to half its diagonal over the distance from the centre.
void thresholds(Rows& rows) {
  constexpr double radius = 0.5, threshold = 0.25, stops = radius + threshold;
  const Field ball = sphere_field(cube_grid(1.5, 61), radius);
  const Object object{&ball, {}};
  for (const double thresholds : {0.04, 0.4, 4.0, 12.0}) {
    Rules rules = impact(1, Sweep::on);
    rules.impact->threshold = threshold;
    const double step = thresholds * threshold;
    const int n_steps = static_cast<int>(std::ceil(3 / step));
    double changed = 0, off = 0;
    for (int i = 0; i < 60; ++i) {
      const double beside = 0.022 * i * stops;
      if (std::abs(beside / stops - 1) < 0.03) continue;
      const Vec3 start{-1.4, beside * std::cos(2.4 * i), beside * std::sin(2.4 * i)}, way{1, 0, 0};
      const Particle end = flown(rules, step, n_steps, {&object, 1}, {start, way});
      if (beside > stops) {
        changed += end.velocity == way ? 0 : 1;
      } else {
        const Vec3 met{-std::sqrt(stops * stops - beside * beside), start.y, start.z};
        const Vec3 normal = direction(met);
        worsen(off, norm(end.velocity - way + 2 * dot(normal, way) * normal));
      }
    }
    rows.add("ball with threshold: passers met", "v dt/threshold", thresholds, changed, 0);
    rows.add("ball with threshold: angle", "v dt/threshold", thresholds, off,
             2.2 * static_cast<double>(half_diagonal) * ball.grid.cell / stops);
  }
}

/// A closed room: eight corners, met again and again.
void corners(Rows& rows) {
  const double half = 1;
  const Field room = room_field(cube_grid(1.5, 40), half);
  const Object object{&room, {}};
  for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
    for (const double speed : {0.1, 3.0, 100.0}) {
      const Particle end = flown(impact(1, Sweep::on, look_up), 0.05, 2000, {&object, 1},
                                 {{0.1, 0.2, 0.3}, speed * direction({1, 1, 1})});
      const Vec3 a = end.position;
      double outside = -half;
      for (const double one : {a.x, a.y, a.z}) worsen(outside, std::abs(one) - half);
      rows.add("corners: |v|", "speed", speed, total_speed_error(end, speed), 1e-11);
      rows.add("corners: outside", "speed", speed, outside,
               look_up == LookUp::tangent ? 1e-6 : 0.87 * room.grid.cell);
    }
}

void moving_walls(Rows& rows) {
  const Field floor = plane_field(cube_grid(2, 9), {0, 0, 1});
  for (const double restitution : {0.0, 0.5, 1.0})
    for (const double speed : {1e-3, 1.0, 100.0}) {
      Object object{&floor, {}};
      object.frame.velocity = {0, 0, speed};
      const Particle end =
          flown(impact(restitution, Sweep::on), 0.2 / speed, 4, {&object, 1}, {{0, 0, 0.5}, {}});
      rows.add("moving plate", "restitution", restitution,
               std::abs(end.velocity.z / ((1 + restitution) * speed) - 1), 1e-12);
    }
  // A disc that spins in its own plane adds no speed.
  for (const double spin : {1e-3, 1.0, 1e3, 1e6}) {
    Object object{&floor, {}};
    object.frame.angular_velocity = {0, 0, spin};
    const Particle end =
        flown(impact(1, Sweep::on), 1, 8, {&object, 1}, {{0.3, 0.2, 1}, {0, 0, -0.25}});
    rows.add("spinning disc: |v|", "spin × dt", spin, total_speed_error(end, 0.25), 1e-12);
  }
  // A spinning ball adds at most twice its surface's speed.
  const Field ball = sphere_field(cube_grid(2, 33), 0.5);
  for (const double spin : {1e-3, 1.0, 1e3, 1e6}) {
    Object object{&ball, {}};
    object.frame.angular_velocity = {0, spin, 0.5 * spin};
    const Particle end =
        flown(impact(1, Sweep::on), 0.1, 50, {&object, 1}, {{1.5, 0.1, 0.05}, {-1, 0, 0}});
    const double excess = norm(end.velocity) - 1 - 2 * 0.6 * 1.12 * spin;
    rows.add("spinning ball: excess of |v|", "spin × dt", 0.1 * spin,
             is_finite(end.position) ? excess : HUGE_VAL, 1e-9);
  }
}

/// Surfaces that come from beyond their field in a step, and balls that grow and shrink: a particle
/// leaves with 2 u - v.
void approaching_walls(Rows& rows) {
  const Field floor = plane_field(cube_grid(2, 9), {0, 0, 1});
  for (const double thicknesses : {1.0, 1e2, 1e4, 1e6}) {
    Object object{&floor, {}};
    object.frame.position = {0, 0, -thicknesses};
    object.frame.velocity = {0, 0, 2 * thicknesses};
    const Particle end = flown(impact(1, Sweep::on), 1, 1, {&object, 1}, {{0.1, 0.2, 0.5}, {}});
    rows.add("plate from beyond", "u dt/thickness", thicknesses,
             std::abs(end.velocity.z / (4 * thicknesses) - 1), 1e-9);
  }
  const Field ball = sphere_field(cube_grid(2, 33), 0.5);
  for (const double growth : {1e-3, 1e-1, 1.0, 1e2, 1e6}) {
    Object object{&ball, {}};
    object.frame.scale_rate = 1;  // the surface at (1 + t)/2
    const int n_steps = static_cast<int>(std::ceil(2 / growth));
    const Particle end =
        flown(impact(1, Sweep::on), growth, n_steps, {&object, 1}, {{1, 0, 0}, {}});
    rows.add("growing ball", "growth a step", growth, norm(end.velocity - Vec3{1, 0, 0}), 1e-5);
  }
  for (const int n_steps : {1, 10, 1000}) {
    Object object{&ball, {}};
    object.frame.scale_rate = -(1 - 1e-6);
    const Particle end = flown(impact(1, Sweep::on), 1.0 / n_steps, n_steps, {&object, 1},
                               {{1.5, 0, 0}, {-2, 0, 0}});
    rows.add("ball that shrinks to 1e-6", "steps", n_steps, norm(end.velocity - Vec3{1, 0, 0}),
             1e-4);
  }
}

/// A particle at rest on a surface that moves far in a step goes with it; a spinning room keeps the
/// particles inside it.
void taken_along(Rows& rows) {
  const Field slab = plane_field(cube_grid(1.5, 60), direction({1, 0, 3}));
  for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
    for (const double cells : {0.1, 1.0, 10.0}) {
      const double step = 0.01, speed = cells * slab.grid.cell / step;
      std::vector<Object> objects{{&slab, {}}};
      objects[0].frame.velocity = {0, 0, speed};
      const int n_steps = static_cast<int>(1.5 / (speed * step));
      const Particle end =
          flown(impact(0, Sweep::on, look_up), step, n_steps, objects, {{-0.2, 0.1, 0.4}, {}});
      advance(objects, step, n_steps);
      const Vec3 seen = objects[0].frame.to_object(end.position);
      const double depth = -dot(seen, direction({1, 0, 3})) / slab.grid.cell;
      rows.add("taken along: depth", "cells a step", cells, depth, 0.75);
    }
  constexpr double wall = 0.8;
  const Field room = room_field(cube_grid(1.2, 61), wall);
  for (const double angle : {0.01, 0.3, 3.0, 300.0})
    for (const double speed : {1.0, 1e3}) {  // rooms a step
      const double step = 0.01;
      std::vector<Object> objects{{&room, {}}};
      objects[0].frame.angular_velocity = angle / step * direction({2, -1, 3});
      const Particle end = flown(impact(0.7, Sweep::on), step, 50, objects,
                                 {{}, speed / step * direction({1, 2, -2})});
      advance(objects, step, 50);
      const Vec3 seen = objects[0].frame.to_object(end.position);
      const double out = std::max({std::abs(seen.x), std::abs(seen.y), std::abs(seen.z)}) - wall;
      rows.add("spinning room: cells out of it", "radians a step", angle,
               is_finite(seen) ? out / room.grid.cell : HUGE_VAL, 1);
    }
}

/// A particle held by drag on a slope for a million steps: it creeps with the speed that balances
/// gravity, and stays on the slope.
void slope(Rows& rows) {
  const Vec3 normal = direction({1, 0, 2});
  const Field plane = plane_field(cube_grid(2, 33), normal);
  const Object object{&plane, {}};
  const double rate = 1e5, creep = 9.81 * std::sqrt(0.2) / rate;  // 0.04 in all
  for (const LookUp look_up : {LookUp::tangent, LookUp::trilinear})
    for (const double restitution : {0.0, 0.7}) {
      Rules rules = impact(restitution, Sweep::on, look_up);
      rules.gravity = Gravity{{0, 0, -9.81}};
      rules.surface_drag = SurfaceDrag{rate, 0.1};
      const int n_steps = 1'000'000;
      const Particle end = flown(rules, 1e-3, n_steps, {&object, 1}, {{-0.5, 0, 0.25}, {}});
      rows.add("rest on a slope: distance", "steps", n_steps, std::abs(dot(end.position, normal)),
               1e-3 * 2 / 16);
      rows.add("rest on a slope: speed", "steps", n_steps, std::abs(norm(end.velocity) / creep - 1),
               1e-3);
    }
}

double distance_at(const Field& field, Vec3 p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float distance = 0;
  look_up(field, LookUp::tangent, {{&x, 1}, {&y, 1}, {&z, 1}}, {{&distance, 1}, {}, {}, {}});
  return static_cast<double>(distance);
}

/// All rules at once that add no energy: it may not grow.
void all_rules(Rows& rows) {
  const Field room = room_field(cube_grid(1.5, 40), 1);
  const Field ball = sphere_field(cube_grid(1, 33), 0.3);
  const Object objects[] = {{&room, {}}, {&ball, {}}};
  const Vec3 g{0, 0, -1};
  for (const double stiff : {1e-6, 1e-2, 1.0, 1e2, 1e6}) {
    const double step = 0.02, k = stiff / (step * step), reach = 0.05;
    Rules rules = impact(0.7, Sweep::on);
    rules.spring = Spring{k, 0.2 * std::sqrt(k), reach};
    rules.surface_drag = SurfaceDrag{0.1 * stiff / step, 0.1};
    rules.surface_flow = SurfaceFlow{stiff / step, stiff / step, 0.2};
    rules.air_drag = AirDrag{1e-3, DragLaw::quadratic};
    rules.gravity = Gravity{g};
    const Stepper stepper = make_stepper(rules, step);
    Particles particles;
    for (int i = 0; i < 64; ++i)
      particles.push_back(
          {0.8 * std::sin(1.0 * i), 0.8 * std::sin(2.3 * i), 0.45 + 0.4 * std::sin(3.7 * i)},
          3 * Vec3{std::sin(5.1 * i), std::sin(7.7 * i), std::sin(9.1 * i)});
    std::vector<double> before(particles.size(), HUGE_VAL);
    double gain = 0;
    for (int i = 0; i < 300; ++i) {
      stepper.run(particles.span(), objects, 0, 1);
      for (std::size_t p = 0; p < particles.size(); ++p) {
        // The spring acts on the sampled distance; in a corner the voxel stores one wall.
        const Vec3 x = particles.position(p), v = particles.velocity(p);
        const double distance = std::min(distance_at(room, x), distance_at(ball, x));
        const double depth = std::max(0.0, reach - distance);
        const double energy = 0.5 * dot(v, v) - dot(g, x) + 0.5 * k * depth * depth;
        if (!(energy < HUGE_VAL)) gain = HUGE_VAL;
        if (i > 100) worsen(gain, energy / (before[p] + 2) - 1);
        if (i > 100)
          before[p] = std::min(before[p], energy);
        else
          before[p] = energy;
      }
    }
    rows.add("all rules: energy gained", "k dt²/m", stiff, gain, 1e-2);
  }
}

}  // namespace

void extreme_motion(Rows& rows) {
  fast(rows);
  grazing(rows);
  thresholds(rows);
  corners(rows);
  moving_walls(rows);
  approaching_walls(rows);
  taken_along(rows);
  slope(rows);
  all_rules(rows);
}

}  // namespace tess::dn::stability
