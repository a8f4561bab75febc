#include "collide/dn_field/field_match.hpp"

#include "collide/dn_field/build_blurred.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/dn_field/field_samples.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

TEST_CASE("a field matches its own surface, however it was built, and no other", "[dn_field]") {
  const Surface box = make_box({1, 0.6, 0.4}), sphere = make_sphere(0.7, 24);
  Surface moved = box;
  for (Vec3& p : moved.vertices) p += Vec3{0.1, 0, 0};
  for (const int n : {16, 33}) {
    const Grid grid = grid_around(bounds(box), n, 0.5);
    std::vector<Field> fields{build_exact(box, grid),
                              build_exact(box, grid, {Sides::two, Content::distance, 0.5, {}})};
    for (const Method method : {Method::normals, Method::potential})
      fields.push_back(build_blurred(box, grid, {method, Sides::one, 0.5, {}, {}}));
    for (const Field& field : fields) {
      INFO(n << " voxels, method " << static_cast<int>(field.method));
      CHECK(mismatch(field, box) < 1e-3);
      CHECK(mismatch(field, with_flipped(box, 3)) < 1e-3);
      CHECK(mismatch(field, sphere) > 1);
      CHECK(mismatch(field, moved) > 0.5 * 0.1 / grid.cell);
    }
  }
  Field unknown = build_exact(box, grid_around(bounds(box), 16, 0.5));
  unknown.distance.assign(unknown.distance.size(), NAN);
  CHECK_FALSE(mismatch(unknown, box) < 1e9);
  CHECK(refusal([&] {
          (void)mismatch(build_exact(box, grid_around(bounds(box), 16, 0.5)), {});
        }).empty() == false);
}

}  // namespace
