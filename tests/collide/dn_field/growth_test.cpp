// Objects that grow, shrink or move fast against particles: what leaves a wall of speed u has
// 2 u − v, whatever the step; nothing passes.
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/shapes.hpp"
#include "collide/dn_field/stepper.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess::dn;

Rules elastic(LookUp kind) {
  Rules rules;
  rules.look_up = kind;
  rules.impact = Impact{1, 0, Sweep::on};
  return rules;
}

/// Around a sphere of radius 1, exact by a formula; the field reaches 1 beyond it.
const Field& unit_sphere() {
  static const Field field = sphere_field(cube_grid(2, 65), 1);
  return field;
}

struct Flown {
  Vec3 position, velocity;
};

Flown flown(const Rules& rules, const Object& object, Flown particle, double step, int n_steps) {
  Particles one;
  one.push_back(particle.position, particle.velocity);
  make_stepper(rules, step).run(one.span(), {&object, 1}, 0, n_steps);
  return {one.position(0), one.velocity(0)};
}

TEST_CASE("a growing or shrinking sphere throws particles back with 2 u - v",
          "[dn_field][growth]") {
  struct Case {
    double rate, start, speed;  // of the scale; of the particle, along the radius
  };
  // The wall stands at 1 + rate t. The particle meets it, and is thrown back once.
  const auto [rate, start, speed] =
      GENERATE(Case{0.5, 1.3, 0}, Case{0.5, 1.3, -1}, Case{2, 1.5, 0.5}, Case{-0.3, 1.2, -1},
               Case{100, 1.9, 3}, Case{1e5, 40, 0});
  const double met = (start - 1) / (rate - speed), wall = 1 + rate * met;
  const double after = 2 * rate - speed, whole = 1.7 * met;
  const Vec3 out = direction({1, -2, 0.5});
  for (const int n_steps : {1, 3, 10, 64, 300})
    for (const LookUp kind : {LookUp::tangent, LookUp::trilinear}) {
      INFO("rate " << rate << ", " << n_steps << " steps");
      Object object{&unit_sphere(), {}};
      object.frame.position = {5, 6, 7};
      object.frame.scale_rate = rate;
      const Flown end =
          flown(elastic(kind), object, {object.frame.position + start * out, speed * out},
                whole / n_steps, n_steps);
      // The tangent look-up is off by the square of half a cell's diagonal times the curvature, its
      // normal by that half times the curvature.
      const double cell = unit_sphere().grid.cell, off = 3 * cell * cell;
      const Vec3 radial = end.position - object.frame.position;
      CHECK(dot(end.velocity, out) == Approx(after).epsilon(0.01));
      CHECK(norm(end.velocity - dot(end.velocity, out) * out) < 1.8 * cell * (rate - speed));
      CHECK(dot(radial, out) ==
            Approx(wall + after * (whole - met)).epsilon(0.01).margin(off * wall));
    }
}

TEST_CASE("a growing box throws back exactly: its faces are planes", "[dn_field][growth]") {
  const Surface box = make_box({1, 1, 1});
  const Field field = build_field(box, grid_around(bounds(box), 24, 1), {});
  for (const int n_steps : {1, 7, 50, 200}) {
    Object object{&field, {}};
    object.frame.scale = 0.5;
    object.frame.scale_rate = 0.25;  // faces at 0.5 + t/4
    object.frame.velocity = {0, 0.3, 0.1};
    const double met = 0.4 / (0.25 + 0.1 + 1), whole = 1;
    const Flown end = flown(elastic(LookUp::tangent), object, {{0.1, 0, 0.9}, {0, 0, -1}},
                            whole / n_steps, n_steps);
    const double after = 2 * (0.25 + 0.1) + 1;
    CHECK(end.velocity.x == Approx(0).margin(1e-5));
    CHECK(end.velocity.z == Approx(after).epsilon(1e-5));
    CHECK(end.position.z == Approx(0.9 - met + after * (whole - met)).epsilon(1e-4));
  }
}

TEST_CASE("drag near a growing surface takes the surface's velocity", "[dn_field][growth]") {
  Rules rules;
  rules.surface_drag = SurfaceDrag{1e3, 0.4};
  rules.impact = Impact{0, 0, Sweep::on};
  Object object{&unit_sphere(), {}};
  object.frame.scale_rate = 0.5;
  const Flown end = flown(rules, object, {{0, 1.1, 0}, {}}, 0.01, 100);
  CHECK(end.velocity.y == Approx(0.5).epsilon(1e-3));
  CHECK(end.position.y == Approx(1.6).epsilon(5e-3));
}

TEST_CASE("an object that comes faster than its field is thick does not pass",
          "[dn_field][growth]") {
  const Surface box = make_box({1, 1, 0.1});
  const Field plate = build_field(box, grid_around(bounds(box), 33, 0.3), {});
  const Field ground = plane_field(cube_grid(8, 33), {0, 0, 1});
  for (const double speed : {1.0, 1e2, 1e4}) {
    INFO("speed " << speed);
    Object falls{&plate, {}};
    falls.frame.position = {0, 0, 3};
    falls.frame.velocity = {0, 0, -speed};
    const double whole = 3.5 / speed, met = 2.9 / speed;
    for (const int n_steps : {1, 2, 40}) {
      // Alone, at rest in the air.
      const Flown end =
          flown(elastic(LookUp::tangent), falls, {{0.2, 0.1, 0}, {}}, whole / n_steps, n_steps);
      CHECK(end.velocity.z == Approx(-2 * speed).epsilon(1e-5));
      CHECK(end.position.z == Approx(-2 * speed * (whole - met)).epsilon(1e-4));
      // Beside another object at rest, which is the closer one.
      Object below{&ground, {}};
      below.frame.position = {0, 0, -2};
      const std::array objects{below, falls};
      Particles one;
      one.push_back({0.2, 0.1, 0}, {});
      const double half = 3.2 / speed;
      make_stepper(elastic(LookUp::tangent), half / n_steps).run(one.span(), objects, 0, n_steps);
      CHECK(one.velocity(0).z == Approx(-2 * speed).epsilon(1e-5));
      CHECK(one.position(0).z == Approx(-2 * speed * (half - met)).epsilon(1e-4));
    }
  }
}

TEST_CASE("among growing objects trajectories are the same however particles and steps are cut",
          "[dn_field][growth]") {
  std::array<Object, 2> objects{{{&unit_sphere(), {}}, {&unit_sphere(), {}}}};
  objects[0].frame.scale_rate = 0.2;
  objects[1].frame.position = {2.2, 0.3, 0};
  objects[1].frame.scale = 0.5;
  objects[1].frame.scale_rate = -0.1;
  objects[1].frame.angular_velocity = {1, 2, 0};
  Rules rules = elastic(LookUp::tangent);
  rules.impact->restitution = 0.8;
  rules.impact->threshold = 0.01;
  rules.spring = Spring{50, 1, 0.1};
  rules.gravity = Gravity{{0, 0, -1}};
  const Stepper stepper = make_stepper(rules, 0.02);
  Particles whole;
  for (int i = 0; i < 500; ++i)
    whole.push_back({2.5 * std::cos(i), 2.5 * std::sin(1.7 * i), 2.5 * std::sin(0.3 * i)},
                    {std::sin(1.1 * i), 3 * std::cos(0.7 * i), std::sin(5.0 * i)});
  Particles parts = whole;
  stepper.run(whole.span(), objects, 0, 100);
  for (std::size_t first = 0; first < parts.size(); first += 37) {
    std::array<Object, 2> moving = objects;
    const std::size_t n = std::min<std::size_t>(37, parts.size() - first);
    for (int done = 0; done < 100; done += 10) {
      stepper.run(parts.span().part(first, n), moving, done * 0.02, 10);
      advance(moving, 0.02, 10);
    }
  }
  CHECK(whole.x == parts.x);
  CHECK(whole.y == parts.y);
  CHECK(whole.z == parts.z);
  CHECK(whole.vx == parts.vx);
  CHECK(whole.vy == parts.vy);
  CHECK(whole.vz == parts.vz);
  for (std::size_t p = 0; p < whole.size(); ++p)
    CHECK((is_finite(whole.position(p)) && is_finite(whole.velocity(p))));
}

TEST_CASE("a rate of growth that is no number is refused", "[dn_field][growth]") {
  Object object{&unit_sphere(), {}};
  object.frame.scale_rate = HUGE_VAL;
  CHECK_THROWS_AS(validate(elastic(LookUp::tangent), {&object, 1}), tess::Error);
}

}  // namespace
