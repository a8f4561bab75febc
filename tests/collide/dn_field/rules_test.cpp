#include "collide/dn_field/rules.hpp"

#include "apps/kit/worst.hpp"
#include "apps/particles/stability/cases.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/shapes.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <array>

namespace {

using namespace tess::dn;
using stability::flown, stability::Particle;

/// The message with which `rules` are refused; empty where they are not.
std::string refusal(const Rules& rules) {
  return tess::test::message_of([&] { validate(rules); });
}

double kinetic_energy(const Particles& particles) {
  double twice = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    twice += dot(particles.velocity(p), particles.velocity(p));
  return 0.5 * twice;
}

TEST_CASE("a bad value of a rule is refused by its key", "[dn_field][rules]") {
  const auto says = [](const Rules& rules, const char* key) {
    INFO(refusal(rules));
    CHECK(refusal(rules).find(key) == 0);
  };
  Rules rules;
  rules.spring = Spring{0, 0, 0};
  says(rules, "spring.stiffness is 0; ");
  rules.spring = Spring{1, 2, 0};
  says(rules, "spring.damping is 2; stay below");
  rules.spring->damping = 0;
  rules.look_up = LookUp::nearest;
  says(rules, "look_up is nearest, which springs do not support");
  rules = {};
  rules.impact = Impact{1.5, 0, Sweep::on};
  says(rules, "impact.restitution is 1.5; ");
  rules.impact = Impact{1, -1, Sweep::on};
  says(rules, "impact.threshold is -1; ");
  rules = {};
  rules.surface_drag = SurfaceDrag{-2, 1};
  says(rules, "surface_drag.rate is -2; ");
  rules = {};
  rules.surface_flow = SurfaceFlow{std::nan(""), 1, 1};
  says(rules, "surface_flow.alpha_in is nan; ");
  rules = {};
  rules.gravity = Gravity{{0, HUGE_VAL, 0}};
  says(rules, "gravity.acceleration is (0, inf, 0); ");
  rules = {};
  rules.wind = Wind{{0, 0, 0}, -1};
  says(rules, "wind.rate is -1; ");
  rules = {};
  rules.explosions = {Explosion{{}, 1, 0, 0, 1}};
  says(rules, "explosion.radius is 0; ");
  CHECK(refusal(Rules{}).empty());
  CHECK_THROWS_AS(make_stepper(Rules{}, 0), tess::Error);
  CHECK_THROWS_AS(make_stepper(Rules{}, std::nan("")), tess::Error);
}

TEST_CASE("normals are asked for where a rule or the look-up needs them", "[dn_field][rules]") {
  Rules rules;
  CHECK_FALSE(needs_field(rules));
  rules.surface_drag = SurfaceDrag{1, 0.5};
  rules.look_up = LookUp::nearest;
  CHECK(needs_field(rules));
  CHECK(reach(rules) == 0.5);
  CHECK(needed_content(rules) == Content::distance);
  rules.impact = Impact{};
  CHECK(needed_content(rules) == Content::distance_and_normal);

  Field floor = plane_field(cube_grid(2, 9), {0, 0, 1});
  floor.normal.clear();
  const Object object{&floor, {}};
  CHECK_THROWS_AS(validate(rules, {&object, 1}), tess::Error);
  rules.impact.reset();
  CHECK_NOTHROW(validate(rules, {&object, 1}));
  const Particle end = flown(rules, 1, 1, {&object, 1}, {{0, 0, 0.1}, {1, 0, 0}});
  CHECK(end.velocity.x == Approx(std::exp(-1.0)));
}

TEST_CASE("wind carries to its own speed, and gravity against drag to the limit",
          "[dn_field][rules]") {
  Rules rules;
  rules.wind = Wind{{3, 0, 0}, 0.5};
  rules.gravity = Gravity{{0, 0, -2}};
  const Particle end = flown(rules, 10, 10, {}, {{}, {0, 1, 0}});
  CHECK(end.velocity.x == Approx(3));
  CHECK(end.velocity.y == Approx(0).margin(1e-20));
  CHECK(end.velocity.z == Approx(-4));
  CHECK(end.position.x == Approx(3 * 100 - 3 / 0.5));
}

TEST_CASE("an explosion gives the same impulse whatever the step", "[dn_field][rules]") {
  Rules rules;
  rules.explosions = {Explosion{{1, 0, 0}, 2e-6, 4, 0.25, 0.5}};
  for (const double step : {1.0, 0.1, 0.01}) {
    const int n_steps = static_cast<int>(std::lround(1 / step));
    const Particle end = flown(rules, step, n_steps, {}, {{2, 0, 0}, {}});
    CHECK(end.velocity.x == Approx(2e-6 * 0.75 * 0.5).epsilon(1e-6));
    CHECK(flown(rules, step, n_steps, {}, {{1, 0, 0}, {}}).velocity == Vec3{});  // its centre
    CHECK(flown(rules, step, n_steps, {}, {{6, 0, 0}, {}}).velocity == Vec3{});  // out of reach
  }
}

TEST_CASE("surface flow turns to the tangent from both sides, and away by a negative coefficient",
          "[dn_field][rules]") {
  const Field floor = plane_field(cube_grid(2, 9), {0, 0, 1});
  const Object object{&floor, {}};
  const auto angle_after = [&](double in, double out, Vec3 velocity) {
    Rules rules;
    rules.surface_flow = SurfaceFlow{in, out, 1};
    const Vec3 v = flown(rules, 0.1, 1, {&object, 1}, {{0, 0, 0.5}, velocity}).velocity;
    CHECK(norm(v) == Approx(norm(velocity)).epsilon(1e-14));
    return std::atan2(v.z, v.x);
  };
  const double start = std::atan2(1, 2);
  const double turn = 0.1 / std::sqrt(5.0);  // step / |V|
  CHECK(angle_after(1, 0, {2, 0, -1}) == Approx(-start + turn));
  CHECK(angle_after(0, 1, {2, 0, 1}) == Approx(start - turn));
  CHECK(angle_after(-1, 0, {2, 0, -1}) == Approx(-start - turn));
  CHECK(angle_after(0, -1, {2, 0, 1}) == Approx(start + turn));
  // All the way but for a millionth, and never beyond.
  CHECK(angle_after(1e9, 0, {2, 0, -1}) == Approx(0).margin(1e-6));
  CHECK(angle_after(1e9, 0, {2, 0, -1}) <= 0);
  CHECK(angle_after(0, -1e9, {2, 0, 1}) == Approx(2 * std::atan(1.0)));
  CHECK(angle_after(1, 1, {0, 0, 1}) == Approx(2 * std::atan(1.0)));  // along N: nothing to turn to
  CHECK(angle_after(1, 1, {0, 0, 0}) == 0);
}

TEST_CASE("drag near a moving surface takes the surface's velocity", "[dn_field][rules]") {
  const Field floor = plane_field(cube_grid(2, 9), {0, 0, 1});
  Object object{&floor, {}};
  object.frame.velocity = {1, 0, 0};
  Rules rules;
  rules.surface_drag = SurfaceDrag{2, 0.5};
  const Particle end = flown(rules, 0.1, 3, {&object, 1}, {{0, 0, 0.2}, {-1, 0, 0}});
  CHECK(end.velocity.x == Approx(1 - 2 * std::exp(-2 * 0.3)));
}

TEST_CASE("what is in a surface is put on it, however fast it slides", "[dn_field][rules]") {
  const Grid grid = cube_grid(2, 17);
  const Field floor = plane_field(grid, {0, 0, 1});
  const Object object{&floor, {}};
  Rules rules;
  rules.impact = Impact{0, 0, Sweep::on};
  for (const double cells_a_step : {0.1, 0.4, 0.6, 3.0, 6.0}) {  // some are traced
    const Vec3 along{cells_a_step * grid.cell, 0, 0};
    const Particle end = flown(rules, 1, 1, {&object, 1}, {{-1.2, 0, -0.3}, along});
    CHECK(end.position.z == Approx(0).margin(2e-3 * grid.cell));
    CHECK(end.position.x == Approx(-1.2 + along.x));
    CHECK(end.velocity == along);
  }
}

TEST_CASE("an impact happens at its place and angle within the step", "[dn_field][rules]") {
  const Vec3 normal = direction({1, 0, 1});
  const Field plane = plane_field(cube_grid(2, 17), normal);
  const Object object{&plane, {}};
  for (const Sweep sweep : {Sweep::off, Sweep::on}) {
    Rules rules;
    rules.impact = Impact{1, 0, sweep};
    const Particle end = flown(rules, 1, 1, {&object, 1}, {{0.1, 0, 0.5}, {0, 0, -1}});
    // It meets the plane at (0.1, 0, -0.1) and leaves along +x.
    CHECK(end.velocity.x == Approx(1).epsilon(1e-4));
    CHECK(end.velocity.z == Approx(0).margin(1e-4));
    CHECK(end.position.x == Approx(0.5).epsilon(1e-4));
    CHECK(end.position.z == Approx(-0.1).margin(1e-4));
    rules.impact->restitution = 0;
    const Particle slides = flown(rules, 1, 1, {&object, 1}, {{0.1, 0, 0.5}, {0, 0, -1}});
    CHECK(slides.velocity.x == Approx(0.5).epsilon(1e-4));
    CHECK(slides.velocity.z == Approx(-0.5).epsilon(1e-4));
  }
}

TEST_CASE("a traced impact keeps the energy of a parabola, seen from the surface",
          "[dn_field][rules]") {
  for (const Vec3 normal : {Vec3{0, 0, 1}, direction({1, 0, 1}), Vec3{1, 0, 0}, Vec3{0, 0, -1}}) {
    const Field plane = plane_field(cube_grid(2, 17), normal);
    for (const double restitution : {1.0, 0.5, 0.0})
      for (const double speed : {0.0, 5.0})  // of the surface
        for (double away = 0; away < 1; away += 0.01) {
          Object object{&plane, {}};
          object.frame.velocity = {0, speed, -speed};
          Rules rules;
          rules.impact = Impact{restitution, 0, Sweep::on};
          rules.gravity = Gravity{{0, 0, -1}};
          const Vec3 start = away * normal, along = Vec3{0.3, 0.1, away - 0.5} - 0.8 * normal;
          const Vec3 u = object.frame.velocity;
          const Particle end = flown(rules, 1, 1, {&object, 1}, {start, along + u});
          const Vec3 v = end.velocity - u, moved = end.position - u - start;
          const double gain = 0.5 * (dot(v, v) - dot(along, along)) + moved.z;
          INFO(normal.x << " " << normal.z << " " << restitution << " " << speed << " " << away);
          CHECK(gain < 1e-12);
          // A particle that would return within the step slides.
          if (restitution == 1 && dot(moved + start, normal) > 1e-6) CHECK(gain > -1e-12);
        }
  }
}

TEST_CASE("a spring adds no energy, by any look-up and stiffness", "[dn_field][rules]") {
  // Curved, with a medial axis within reach, and a corner seen from within: normals that change in
  // a step, that blend to nothing, and that know one wall of three.
  const Surface ball = make_sphere(1, 40), ring = make_torus(1, 0.4, 48);
  const std::array fields{build_field(ball, grid_around(bounds(ball), 40, 0.5)),
                          build_field(ring, grid_around(bounds(ring), 40, 0.5)),
                          room_field(cube_grid(1.5, 40), 1)};
  for (const Field& field : fields)
    for (const LookUp look_up : {LookUp::tangent, LookUp::trilinear})
      for (const double stiffness : {1e2, 1e4, 1e6, 1e8, 1e12, 1e16}) {
        const Object object{&field, {}};
        const bool is_room = &field == &fields.back();
        Rules rules;
        rules.look_up = look_up;
        rules.spring = Spring{stiffness, 0, 0.1};
        Particles particles;
        for (int i = 1; i <= 400; ++i) {
          const Vec3 out = direction({std::sin(i), std::sin(2.3 * i), std::sin(3.7 * i)});
          const Vec3 aside = 0.4 * Vec3{std::sin(5.1 * i), std::sin(7.7 * i), std::sin(9.1 * i)};
          particles.push_back((is_room ? 0.5 : 1.8) * out, (is_room ? 1.4 : -1.4) * out + aside);
        }
        Particles before = particles;
        make_stepper(rules, 0.01).run(particles.span(), {&object, 1}, 0, 300);
        double most = 0;
        for (std::size_t p = 0; p < particles.size(); ++p)
          kit::worsen(most, norm(particles.velocity(p)) / norm(before.velocity(p)));
        INFO("field " << &field - fields.data() << ", look-up " << static_cast<int>(look_up)
                      << ", stiffness " << stiffness);
        CHECK(most < 1 + 1e-4);
        // Soft against the step, it gives back what it took, less what is cut where it bends.
        if (stiffness < 1e4 && !is_room)
          CHECK(kinetic_energy(particles) > 0.95 * kinetic_energy(before));
      }
}

}  // namespace
