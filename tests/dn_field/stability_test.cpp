#include "collide/dn_field/stability.hpp"

#include "collide/dn_field/stability_cases.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess::dn;

TEST_CASE("every stiff and extreme case meets its tolerance", "[dn_field][rules]") {
  const auto rows = stability_report();
  CHECK(rows.size() > 200);
  for (const StabilityRow& row : rows) {
    INFO(row.name << ", " << row.parameter << " = " << row.value << ": " << row.met << " > "
                  << row.tolerance);
    CHECK(row.ok);
  }
}

TEST_CASE("a particle rests on a slope for a million steps", "[.soak][dn_field]") {
  const Vec3 normal = direction({1, 0, 2});
  const Field plane = plane_field(cube_grid(2, 33), normal);
  const Object object{&plane, {}};
  Rules rules;
  rules.impact = Impact{0.7, 0, Sweep::on};
  rules.gravity = Gravity{{0, 0, -9.81}};
  rules.surface_drag = SurfaceDrag{1e5, 0.1, DragLaw::linear};
  const auto end =
      stability::flown(rules, 1e-3, 1'000'000, {&object, 1}, {{-0.5, 0, 0.25}, {0, 0, 0}});
  CHECK(std::abs(dot(end.position, normal)) < 2e-4);
  CHECK(norm(end.velocity) == Approx(9.81 * std::sqrt(0.2) / 1e5).epsilon(1e-3));
}

}  // namespace
