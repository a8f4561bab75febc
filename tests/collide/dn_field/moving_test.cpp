// Objects that move far and turn in a step: no particle passes their surfaces.
#include "apps/kit/worst.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/stepper.hpp"
#include "tests/support/catch.hpp"

#include <random>

namespace {

using namespace tess::dn;

constexpr double dt = 0.01, wall = 0.8;

/// Those inside of `room`, flying with it and `speed` in any direction.
Particles inmates(const Object& room, double speed) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  Particles particles;
  for (int p = 0; p < 100; ++p) {
    const Vec3 x{anywhere(random), anywhere(random), anywhere(random)},
        v{anywhere(random), anywhere(random), anywhere(random)};
    particles.push_back(room.frame.to_world(0.3 * x), room.frame.velocity + speed * v);
  }
  return particles;
}

/// The furthest from the room's centre along one of its axes.
double furthest(const Particles& particles, const Object& room) {
  double most = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec3 x = room.frame.to_object(particles.position(p));
    for (const double one : {x.x, x.y, x.z}) kit::worsen(most, std::abs(one));
  }
  return most;
}

TEST_CASE("no particle leaves a closed room, however the room moves", "[dn_field][rules]") {
  const Field field = room_field(cube_grid(1.2, 61), wall);
  std::vector<Object> rooms(4, Object{&field, {}});
  rooms[1].frame.velocity = {0, 10, 50};
  rooms[2].frame.angular_velocity = {20, -5, 22};
  rooms[3].frame.scale_rate = -0.5;
  rooms[3].frame.velocity = {-20, 3, 0};
  for (const Object& at_first : rooms)
    for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
      for (const double restitution : {0.0, 0.7})
        for (const double speed : {2.0, 1e4})
          for (const bool springs : {false, true}) {
            if (springs && look_up == LookUp::nearest) continue;
            Rules rules;
            rules.look_up = look_up;
            rules.impact = Impact{restitution, 0, Sweep::on};
            rules.gravity = Gravity{{0, 0, -9.81}};
            if (springs) rules.spring = Spring{1e6, 10, 0.1};
            std::vector<Object> objects{at_first};
            Particles particles = inmates(at_first, speed);
            const Stepper stepper = make_stepper(rules, dt);
            stepper.run(particles.span(), objects, 0, 60);
            advance(objects, dt, 60);
            INFO("room " << &at_first - rooms.data() << ", look-up " << static_cast<int>(look_up)
                         << ", restitution " << restitution << ", speed " << speed << ", springs "
                         << springs);
            CHECK(furthest(particles, objects[0]) < wall + 1.55 * field.grid.cell);
          }
}

TEST_CASE("a box that ploughs through particles at rest takes them along", "[dn_field][rules]") {
  const Field field = plane_field(cube_grid(1.5, 60), {0, 0, 1});
  for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
    for (const double speed : {5.0, 20.0, 50.0})
      for (const double tilt : {0.0, 0.3, 0.35, 0.36}) {  // the surface is a boundary of voxels
        Rules rules;
        rules.look_up = look_up;
        rules.impact = Impact{0, 0, Sweep::on};
        rules.gravity = Gravity{{0, 0, -9.81}};
        std::vector<Object> objects{{&field, {}}};
        objects[0].frame.axes = rotation({tilt, 0, 0});
        objects[0].frame.velocity = {0, 0, speed};
        Particles particles;
        std::mt19937 random(7);
        std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
        for (int p = 0; p < 200; ++p)
          particles.push_back({anywhere(random), anywhere(random), 0.9 + anywhere(random)}, {});
        const Stepper stepper = make_stepper(rules, dt);
        const int n_steps = static_cast<int>(2 / (speed * dt));  // they slide: not off the field
        stepper.run(particles.span(), objects, 0, n_steps);
        advance(objects, dt, n_steps);
        double lowest = HUGE_VAL;
        for (std::size_t p = 0; p < particles.size(); ++p)
          kit::lower(lowest, objects[0].frame.to_object(particles.position(p)).z);
        INFO("look-up " << static_cast<int>(look_up) << ", speed " << speed << ", tilt " << tilt);
        CHECK(lowest > -field.grid.cell);
      }
}

}  // namespace
