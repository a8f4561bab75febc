#include "collide/dn_field/stepper.hpp"

#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/shapes.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cstring>
#include <random>

namespace {

using namespace tess::dn;

Rules everything() {
  Rules rules;
  rules.spring = Spring{50, 1, 0.1};
  rules.impact = Impact{0.7, 0.01, Sweep::on};
  rules.surface_drag = SurfaceDrag{0.5, 0.2};
  rules.surface_flow = SurfaceFlow{1, 2, 0.3};
  rules.gravity = Gravity{{0, 0, -1}};
  rules.wind = Wind{{1, 0, 0}, 0.2};
  rules.air_drag = AirDrag{0.1, DragLaw::quadratic};
  rules.explosions = {Explosion{{0, 0, 0}, 3, 2, 0.1, 0.1}};
  return rules;
}

Particles some(std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(-1.5, 1.5);
  Particles particles;
  for (std::size_t p = 0; p < count; ++p) {
    const Vec3 x{anywhere(random), anywhere(random), anywhere(random)};
    particles.push_back(x, 2 * Vec3{anywhere(random), anywhere(random), anywhere(random)});
  }
  return particles;
}

bool same(const Values& a, const Values& b) {  // the sign of a zero too
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
bool same(const Particles& a, const Particles& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.vx, b.vx) &&
         same(a.vy, b.vy) && same(a.vz, b.vz);
}

TEST_CASE("trajectories are bit-identical however particles and steps are cut",
          "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1.5, 24), 0.6);
  std::array<Object, 2> objects{{{&ball, {}}, {&ball, {}}}};
  objects[1].frame.position = {1.2, 0.3, 0};
  objects[1].frame.scale = 0.5;
  objects[1].frame.angular_velocity = {1, 2, 0};
  objects[1].frame.velocity = {0, 0.5, 0};
  for (const std::size_t n_objects : {std::size_t{1}, std::size_t{2}}) {
    INFO(n_objects << " objects");
    const std::span<const Object> standing(objects.data(), n_objects);
    const Stepper stepper = make_stepper(everything(), 0.02);
    const std::size_t count = 1003;
    Particles whole = some(count), parts = some(count), singles = some(count);
    stepper.run(whole.span(), standing, 0, 100);
    // Odd parts, odd numbers of steps.
    for (std::size_t first = 0; first < count; first += 37) {
      std::vector<Object> moving(standing.begin(), standing.end());
      const std::size_t n = std::min<std::size_t>(37, count - first);
      for (int done = 0; done < 100; done += 10) {
        stepper.run(parts.span().part(first, n), moving, done * 0.02, 10);
        advance(moving, 0.02, 10);
      }
    }
    CHECK(same(whole, parts));
    for (std::size_t p = 0; p < count; p += 50)
      stepper.run(singles.span().part(p, 1), standing, 0, 100);
    for (std::size_t p = 0; p < count; p += 50) {
      CHECK(singles.position(p) == whole.position(p));
      CHECK(singles.velocity(p) == whole.velocity(p));
    }
    for (std::size_t p = 0; p < whole.size(); ++p)
      CHECK((is_finite(whole.position(p)) && is_finite(whole.velocity(p))));
  }
}

TEST_CASE("a trajectory does not depend on how long a particle was culled", "[dn_field][rules]") {
  // Particles are left alone for many steps where the surface is far. Alone in its block each takes
  // the look-ups of all its steps, or of none; by the nearest look-up distances jump between
  // voxels.
  const Field ball = sphere_field(cube_grid(1.5, 24), 0.6);
  Field holed = ball;  // as of a mesh with a hole: neighbours of opposite sign
  for (std::size_t at = 0; at < holed.distance.size(); at += 7) holed.distance[at] *= -1;
  holed.jump = greatest_jump(holed);
  std::vector<Rules> scenes(5);
  scenes[0] = everything();
  scenes[0].impact->sweep = Sweep::off;
  scenes[1].surface_drag = SurfaceDrag{0.5, 0.2};
  scenes[2] = scenes[1];
  scenes[2].gravity = Gravity{{0.3, 0.7, -9.81}};
  scenes[3].impact = Impact{1, 0.01, Sweep::off};
  scenes[4] = scenes[3];
  scenes[4].explosions = {Explosion{{4, 0, 0}, 1, 0.5, 0, 1}};  // reaches some
  const std::size_t count = 600;
  Particles start = some(count);
  for (std::size_t p = 0; p < count; ++p) {
    if (p % 3 == 0) start.vy[p] = -0.0;  // bits count
    if (p % 4 != 0) start.x[p] += 4;     // outside of the field
  }
  for (Rules& rules : scenes)
    for (const Field* field : {&ball, &static_cast<const Field&>(holed)})
      for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
        for (const Vec3 spin : {Vec3{}, Vec3{3, 0, 1}}) {
          if (rules.spring && look_up == LookUp::nearest) continue;
          Object object{field, {}};
          object.frame.angular_velocity = spin;
          rules.look_up = look_up;
          const Stepper stepper = make_stepper(rules, 0.004);
          Particles together = start, alone = start;
          stepper.run(together.span(), {&object, 1}, 0, 100);
          for (std::size_t p = 0; p < count; ++p)
            stepper.run(alone.span().part(p, 1), {&object, 1}, 0, 100);
          INFO("scene " << &rules - scenes.data() << ", look-up " << static_cast<int>(look_up));
          CHECK(same(together, alone));
        }
}

TEST_CASE("a scene in a moving, turned, scaled frame is the scene at rest seen from there",
          "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1.5, 32), 0.6);
  Rules rules;
  rules.impact = Impact{0.5, 0, Sweep::on};
  rules.surface_flow = SurfaceFlow{1, 1, 0.2};
  Object rest{&ball, {}}, moving{&ball, {}};
  moving.frame.axes = rotation({0.3, -1, 0.4});
  moving.frame.position = {5, -3, 2};
  moving.frame.velocity = {0.5, 0.25, -1};
  moving.frame.scale = 3;
  Rules scaled = rules;
  scaled.surface_flow = SurfaceFlow{3, 3, 0.6};  // an acceleration, a distance
  Particles still = some(200), carried;
  for (std::size_t p = 0; p < 200; ++p)
    carried.push_back(moving.frame.to_world(still.position(p)),
                      moving.frame.velocity + 3 * moving.frame.rotate(still.velocity(p)));
  make_stepper(rules, 0.01).run(still.span(), {&rest, 1}, 0, 60);
  make_stepper(scaled, 0.01).run(carried.span(), {&moving, 1}, 0, 60);
  advance({&moving, 1}, 0.01, 60);
  int off = 0;
  for (std::size_t p = 0; p < 200; ++p)
    off += norm(moving.frame.to_object(carried.position(p)) - still.position(p)) > 1e-3 ? 1 : 0;
  CHECK(off <= 6);  // rounding at a voxel's border may select the neighbour's normal
}

TEST_CASE("a particle that a stiff spring returns, returns as seen from a moving object",
          "[dn_field][rules]") {
  const Field room = room_field(cube_grid(1.5, 40), 1);
  Rules rules;
  rules.spring = Spring{1e8, 0, 0.1};
  const Object rest{&room, {}};
  Object moving{&room, {}};
  moving.frame.position = {4, -2, 8};
  moving.frame.velocity = {3, -5, 2};
  const Particles start = some(4000);
  Particles still = start, carried;
  for (std::size_t p = 0; p < start.size(); ++p)
    carried.push_back(moving.frame.position + start.position(p),
                      moving.frame.velocity + start.velocity(p));
  constexpr double step = 0.1;
  make_stepper(rules, step).run(still.span(), {&rest, 1}, 0);
  make_stepper(rules, step).run(carried.span(), {&moving, 1}, 0);
  const Vec3 gone = moving.frame.position + step * moving.frame.velocity;
  int n_returned = 0, n_off = 0;
  for (std::size_t p = 0; p < start.size(); ++p) {
    if (still.position(p) != start.position(p) || still.velocity(p) != -1 * start.velocity(p))
      continue;
    ++n_returned;
    const bool same_place = norm(carried.position(p) - gone - still.position(p)) < 1e-12;
    const bool same_velocity =
        norm(carried.velocity(p) - moving.frame.velocity - still.velocity(p)) < 1e-12;
    n_off += same_place && same_velocity ? 0 : 1;
  }
  INFO(n_returned << " returned, " << n_off << " of them elsewhere");
  CHECK(n_returned > 50);
  CHECK(n_off * 20 <= n_returned);  // rounding at a voxel's border may select its neighbour
}

TEST_CASE("waypoints name their particles, whether others of the block are near or far",
          "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1.5, 24), 0.6);
  const Object object{&ball, {}};
  Rules rules;
  rules.impact = Impact{0.5, 0, Sweep::on};
  const Stepper stepper = make_stepper(rules, 0.1);
  Particles crowd;
  for (int p = 0; p < 700; ++p) {
    const bool is_near = p % 29 == 5;
    const Vec3 out = direction({std::sin(p), std::sin(2.3 * p), std::sin(3.7 * p)});
    crowd.push_back((is_near ? 1.2 : 30) * out, (is_near ? -20 : 0.1) * out);
  }
  Particles alone = crowd;
  const std::vector<Waypoint> together = stepper.run_once(crowd.span(), {&object, 1}, 0);
  std::vector<Waypoint> want;
  for (std::size_t p = 0; p < alone.size(); ++p)
    for (Waypoint bend : stepper.run_once(alone.span().part(p, 1), {&object, 1}, 0)) {
      bend.particle += p;
      want.push_back(bend);
    }
  REQUIRE(together.size() == want.size());
  CHECK(want.size() >= 2 * 24);  // where the path is first bent, and at the bounce
  for (std::size_t i = 0; i < want.size(); ++i) {
    CHECK(together[i].particle == want[i].particle);
    CHECK(together[i].part == want[i].part);
    CHECK(together[i].place == want[i].place);
  }
}

TEST_CASE(
    "of two surfaces in one voxel a particle meets the first on its way, in any order of objects",
    "[dn_field][rules]") {
  const Field floor = plane_field(cube_grid(2, 9), {0, 0, 1});  // voxels of 0.5
  Rules rules;
  rules.impact = Impact{1, 0, Sweep::on};
  for (const double below : {0.02, 0.1, 0.2})
    for (const bool turned : {false, true}) {
      std::array<Object, 2> objects{{{&floor, {}}, {&floor, {}}}};
      objects[turned ? 0 : 1].frame.position = {0, 0, -below};
      Particles one;
      one.push_back({0.1, 0.2, 1.1}, {0, 0, -3});
      make_stepper(rules, 1).run(one.span(), objects, 0);
      INFO("the other one " << below << " below, listed " << (turned ? "first" : "last"));
      CHECK(one.position(0).z == Approx(3 - 1.1).epsilon(1e-5));
      CHECK(one.velocity(0).z == Approx(3).epsilon(1e-5));
    }
}

TEST_CASE("particles outside every field fly straight", "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1, 16), 0.5);
  const Object object{&ball, {}};
  Rules rules;
  rules.impact = Impact{};
  Particles particles;
  particles.push_back({5, 5, 5}, {1, 0, 0});
  make_stepper(rules, 0.5).run(particles.span(), {&object, 1}, 0, 4);
  CHECK(particles.position(0) == Vec3{7, 5, 5});
  make_stepper(rules, 0.5).run(particles.span(), {}, 0, 4);
  CHECK(particles.position(0) == Vec3{9, 5, 5});
}

TEST_CASE("bounces off a built box are those of the exact box", "[dn_field][rules]") {
  const Surface box = make_box({0.5, 0.5, 0.5});
  const Field field = build_field(box, grid_around(bounds(box), 40, 0.5));
  const Object object{&field, {}};
  Rules rules;
  rules.impact = Impact{1, 0, Sweep::on};
  for (const double speed : {0.3, 3.0, 3e4}) {
    Particles particles;
    for (int i = 0; i < 50; ++i)
      particles.push_back({0.4 * std::sin(1.0 * i), 0.4 * std::cos(2.0 * i), 0.9}, {0, 0, -speed});
    const double step = 0.05 / 0.3;
    make_stepper(rules, step).run(particles.span(), {&object, 1}, 0, 12);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      // Down 0.4 to the box, back up.
      CHECK(particles.vz[p] == Approx(speed));
      CHECK(particles.z[p] == Approx(0.5 + (12 * step * speed - 0.4)).margin(1e-4));
    }
  }
}

TEST_CASE("a particle of any speed bounces off an object, at rest or in motion",
          "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1.5, 24), 0.6);
  std::array<Object, 5> objects;
  objects.fill({&ball, {}});
  objects[1].frame.axes = rotation({0.3, -1, 0.4});
  objects[2].frame.velocity = {0.5, 0.25, -1};
  objects[3].frame.angular_velocity = {0.3, -1, 0.4};
  objects[4].frame.scale_rate = -0.1;
  Rules rules;
  rules.impact = Impact{1, 0, Sweep::on};
  for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
    for (const Object& object : objects)
      for (const double speed : {1e6, 1e17, 1e18, 1e19, 1e25, 1e37, 1e39, 1e45, 1e100}) {
        rules.look_up = look_up;
        INFO(name_of(look_up) << ", object " << &object - objects.data() << ", speed " << speed);
        Particles one;
        one.push_back({0.1, 0.2, 3}, {0, 0, -speed});
        // The second step begins further away than the first went.
        make_stepper(rules, 1).run(one.span(), {&object, 1}, 0, 2);
        CHECK(norm(one.velocity(0)) == Approx(speed).epsilon(2 / speed + 1e-9));
        CHECK(one.vz[0] > 0.5 * speed);
        CHECK(norm(one.position(0)) == Approx(2 * speed).epsilon(5 / speed + 1e-9));
      }
}

TEST_CASE("objects that cannot serve are refused with a reason", "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1, 16), 0.5);
  Rules rules;
  rules.impact = Impact{};
  Object object{nullptr, {}};
  CHECK_THROWS_AS(validate(rules, {&object, 1}), tess::Error);
  object.field = &ball;
  object.frame.scale = 0;
  CHECK_THROWS_AS(validate(rules, {&object, 1}), tess::Error);
  object.frame.scale = 1;
  Field thin = ball;
  thin.thickness = 0.1;
  object.field = &thin;
  rules.surface_drag = SurfaceDrag{1, 0.2};
  CHECK_THROWS_AS(validate(rules, {&object, 1}), tess::Error);
  object.frame.scale = 2;
  CHECK_NOTHROW(validate(rules, {&object, 1}));
  object.frame.velocity.x = std::nan("");
  CHECK_THROWS_AS(validate(rules, {&object, 1}), tess::Error);
}

TEST_CASE("a rule may reach as far as the field is thick, and does not act beyond",
          "[dn_field][step]") {
  const Surface sphere = make_sphere(1, 20);
  const Grid grid = grid_around(bounds(sphere), 24, 1);
  for (const double thickness : {0.4, 0.45, 0.5, 0.7, 0.9}) {
    const Field flat =
        build_field(sphere, grid, {Sides::one, Content::distance_and_normal, thickness, {}});
    CHECK(flat.thickness == thickness);
    const Field compressed = compress(flat, {0.02, 0.2});
    for (const Field* field : {&flat, &compressed})
      for (const double scale : {1.0, 1.3, 0.7}) {
        Object object{field, {}};
        object.frame.scale = scale;
        Rules rules;
        rules.look_up = LookUp::tangent;
        rules.surface_drag = SurfaceDrag{50, scale * thickness};
        CHECK_NOTHROW(validate(rules, {&object, 1}));
        if (field == &compressed) continue;  // its distances are off by up to its bound
        // Within the grid, beyond the thickness.
        Particles particles;
        particles.push_back({scale * (1.05 + thickness), 0, 0}, {0, 0.01, 0});
        make_stepper(rules, 0.1).run(particles.span(), {&object, 1}, 0);
        CHECK(particles.velocity(0).y == 0.01);
      }
  }
}

}  // namespace
