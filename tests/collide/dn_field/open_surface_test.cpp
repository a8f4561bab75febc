#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/stepper.hpp"
#include "tests/support/catch.hpp"

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
  CHECK_THROWS_WITH(validate(rules, {&object, 1}), Contains("only 0.2"));
}

}  // namespace
