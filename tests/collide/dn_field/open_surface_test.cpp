#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/stepper.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <random>

namespace {

using namespace tess::dn;

TEST_CASE("no particle passes an open surface, from either side and in any orientation",
          "[dn_field][rules]") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (const int resolution : {20, 21, 40})
    for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
      for (const Sweep sweep : {Sweep::on, Sweep::off})
        for (const double speed : {0.3, 3.0, 100.0}) {
          if (sweep == Sweep::off && speed > 3) continue;
          const Field sheet = sheet_field(cube_grid(1, resolution));
          Object object{&sheet, {}};
          object.frame.axes = rotation({anywhere(random), anywhere(random), anywhere(random)});
          Rules rules;
          rules.look_up = look_up;
          rules.impact = Impact{0.5, 0, sweep};
          Particles particles;
          std::vector<double> sides;
          for (int p = 0; p < 200; ++p) {
            const double side = p % 2 == 0 ? 1 : -1;
            const Vec3 x{0.3 * anywhere(random), 0.3 * anywhere(random), 0.5 * side};
            const Vec3 v{0.3 * anywhere(random), 0.3 * anywhere(random), -side};
            particles.push_back(object.frame.to_world(x), speed * object.frame.rotate(v));
            sides.push_back(side);
          }
          const int n_steps = static_cast<int>(80 / speed) + 1;
          make_stepper(rules, 0.01).run(particles.span(), {&object, 1}, 0, n_steps);
          int passed = 0;
          for (std::size_t p = 0; p < particles.size(); ++p)
            if (!(sides[p] * object.frame.to_object(particles.position(p)).z > 0)) ++passed;
          INFO("resolution " << resolution << ", look-up " << static_cast<int>(look_up)
                             << ", sweep " << (sweep == Sweep::on) << ", speed " << speed);
          CHECK(passed == 0);
        }
}

/// A long wedge closed at its ends, of five open surfaces. Its corners are `angle` and two of half
/// the rest.
struct WedgeRoom {
  explicit WedgeRoom(double angle) {
    const double half = 0.5 * angle;
    const std::array<Vec3, 3> section{
        {{0, 0, 0}, {std::cos(half), 0, std::sin(half)}, {std::cos(half), 0, -std::sin(half)}}};
    for (const double y : {-0.8, 0.8})
      for (const Vec3 corner : section) surface.vertices.push_back({corner.x, y, corner.z});
    surface.triangles = {{0, 1, 2}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                         {0, 2, 5}, {0, 5, 3}, {1, 2, 5}, {1, 5, 4}};
    up = {-std::sin(half), 0, std::cos(half)}, down = {-std::sin(half), 0, -std::cos(half)};
    back = std::cos(half);
  }
  /// Distance to the nearest wall, negative outside the room.
  [[nodiscard]] double within(Vec3 p) const {
    return std::min({-dot(up, p), -dot(down, p), back - p.x, 0.8 - std::abs(p.y)});
  }
  Surface surface;
  Vec3 up, down;  // outward normals of the two walls that meet at `angle`
  double back;
};

TEST_CASE("no particle leaves a room of open surfaces through its joints", "[dn_field][rules]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  int n_scenes = 0, n_left_alone = 0;  // the latter without triangles
  for (const double angle : {0.5, 0.9, 1.57, 2.4})
    for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
      for (const double restitution : {0.0, 0.5, 1.0})
        for (const double speed : {1.0, 30.0, 1e4})
          for (const bool spins : {false, true}) {
            const bool springs = n_scenes++ % 3 == 0;
            const WedgeRoom room(angle);
            const Grid grid = grid_around(bounds(room.surface), 41, 0.3);
            const Field field = build_field(room.surface, grid,
                                            {Sides::two, Content::distance_and_normal, 0.3, {}});
            const Bvh triangles(room.surface);
            Object object{&field, {}, &triangles};
            object.frame.axes = rotation({anywhere(random), anywhere(random), anywhere(random)});
            if (spins) object.frame.angular_velocity = {1, -2, 3};
            Rules rules;
            rules.look_up = look_up;
            rules.impact = Impact{restitution, 0, Sweep::on};
            const Vec3 into_corner = object.frame.rotate({-9.81, 0, 0});
            rules.gravity = Gravity{into_corner};
            if (springs) rules.spring = Spring{1e5, 0, 0.1};
            Particles particles;
            while (particles.size() < 40) {
              const Vec3 x{room.back * (0.55 + 0.1 * anywhere(random)), anywhere(random),
                           0.2 * anywhere(random)};
              if (room.within(x) < 2 * grid.cell) continue;
              const Vec3 v{-1, 0.3 * anywhere(random), 0.5 * anywhere(random)};
              particles.push_back(object.frame.to_world(x), speed * object.frame.rotate(v));
            }
            Particles alone = particles;
            const Stepper stepper = make_stepper(rules, 0.005);
            const int n_steps = speed > 100 ? 10 : 250;
            const auto left = [&](Particles& some, const Bvh* known) {
              std::vector<Object> objects{object};
              objects[0].triangles = known;
              stepper.run(some.span(), objects, 0, n_steps);
              advance(objects, 0.005, n_steps);
              int n = 0;
              for (std::size_t p = 0; p < some.size(); ++p)
                n += !(room.within(objects[0].frame.to_object(some.position(p))) > 0);
              return n;
            };
            INFO("angle " << angle << ", look-up " << static_cast<int>(look_up) << ", restitution "
                          << restitution << ", speed " << speed << ", spins " << spins
                          << ", springs " << springs);
            CHECK(left(particles, &triangles) == 0);
            n_left_alone += left(alone, nullptr);
          }
  CHECK(n_left_alone > 100);  // otherwise the case would not need the triangles
}

TEST_CASE("a particle that flies into the joint of open surfaces comes out again",
          "[dn_field][rules]") {
  for (const double angle : {0.4, 0.8, 1.9})
    for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
      const WedgeRoom room(angle);
      const Grid grid = grid_around(bounds(room.surface), 41, 0.3);
      const Field field =
          build_field(room.surface, grid, {Sides::two, Content::distance_and_normal, 0.3, {}});
      const Bvh triangles(room.surface);
      const Object object{&field, {}, &triangles};
      Rules rules;
      rules.look_up = look_up;
      rules.impact = Impact{1, 0, Sweep::on};
      Particles particles;
      for (int p = 0; p < 100; ++p)
        particles.push_back({0.6 * room.back, 0.006 * (p - 50), 0},
                            {-3, 0.2 * std::sin(p), 0.6 * std::sin(2.3 * p)});
      const Particles start = particles;
      const Stepper stepper = make_stepper(rules, 0.01);
      stepper.run(particles.span(), {&object, 1}, 0, 400);
      const Particles before = particles;
      stepper.run(particles.span(), {&object, 1}, 4, 5);
      const Particles between = particles;
      stepper.run(particles.span(), {&object, 1}, 4.05, 8);
      INFO("angle " << angle << ", look-up " << static_cast<int>(look_up));
      for (std::size_t p = 0; p < particles.size(); ++p) {
        // The displacements without joints are 0.15 and 0.4; one may lead back.
        CHECK(std::max(norm(between.position(p) - before.position(p)),
                       norm(particles.position(p) - before.position(p))) > 0.01);
        CHECK(room.within(particles.position(p)) > 0);
        CHECK(norm(particles.velocity(p)) == Approx(norm(start.velocity(p))).epsilon(1e-6));
      }
    }
}

TEST_CASE("the reach of a rule lies within the field minus the clearance of an open surface",
          "[dn_field][rules]") {
  const Field sheet = [] {
    Field field = sheet_field(cube_grid(1, 21));
    field.thickness = 0.3;
    return field;
  }();
  const Object object{&sheet, {}};
  Rules rules;
  rules.spring = Spring{1, 0, 0.19};  // cells are 0.1 wide
  CHECK_NOTHROW(validate(rules, {&object, 1}));
  rules.spring->reach = 0.21;
  CHECK_THROWS_WITH(validate(rules, {&object, 1}), Catch::Contains("only 0.2"));
}

}  // namespace
