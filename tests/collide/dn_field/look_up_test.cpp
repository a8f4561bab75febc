#include "collide/dn_field/look_up.hpp"

#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/support/catch.hpp"

#include <random>

namespace {

using namespace tess::dn;

TEST_CASE(
    "the nearest look-up returns the voxel's distance, and is out of reach outside and for NaN",
    "[dn_field]") {
  const Surface box = make_box({0.5, 0.5, 0.5});
  const Field field = build_field(box, grid_around(bounds(box), 20, 0.3));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> anywhere(-1.2F, 1.2F);
  std::vector<float> x(1001), y(1001), z(1001), found(1001);
  for (std::size_t p = 0; p < 1000; ++p)
    x[p] = anywhere(random), y[p] = anywhere(random), z[p] = anywhere(random);
  x[1000] = std::nanf("");
  look_up(field, LookUp::nearest, {x, y, z}, {found, {}, {}, {}});
  CHECK(found[1000] == out_of_reach);
  int inside = 0;
  for (std::size_t p = 0; p < 1000; ++p) {
    const Vec3 g =
        (1 / field.grid.cell) *
        (Vec3{static_cast<double>(x[p]), static_cast<double>(y[p]), static_cast<double>(z[p])} -
         field.grid.origin);
    const int i = static_cast<int>(std::floor(g.x + 0.5)),
              j = static_cast<int>(std::floor(g.y + 0.5)),
              k = static_cast<int>(std::floor(g.z + 0.5));
    const bool in = i >= 0 && j >= 0 && k >= 0 && i < 20 && j < 20 && k < 20;
    inside += in;
    CHECK(found[p] == (in ? field.distance[field.grid.index(i, j, k)] : out_of_reach));
  }
  CHECK(inside > 100);
}

TEST_CASE("a look-up in a field that was not built is refused", "[dn_field]") {
  const std::vector<float> x(3);
  std::vector<float> found(3);
  Field field;
  const auto look = [&](LookUp kind) { look_up(field, kind, {x, x, x}, {.distance = found}); };
  for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
    field = {};
    CHECK_THROWS_WITH(look(kind), Contains("a field of 0 voxels with 0 distances"));
    field.grid = {{0, 0, 0}, 1, {2, 2, 2}};
    CHECK_THROWS_WITH(look(kind), Contains("a field of 8 voxels with 0 distances"));
  }
}

TEST_CASE("between opposite normals the blend is zero, and of unit length a thousandth beside it",
          "[dn_field]") {
  Field field;
  field.grid = {{0, 0, 0}, 1, {2, 2, 2}};
  for (std::size_t at = 0; at < 8; ++at) {
    field.distance.push_back(0.5F);
    field.normal.push_back(encode_normal({at % 2 == 0 ? -1.0 : 1.0, 0, 0}));
  }
  // The blend at x is 2x - 1.
  const std::vector<float> x{0.49F, 0.4992F, 0.4998F, 0.5F, 0.5002F, 0.5008F, 0.51F},
      middle(x.size(), 0.5F);
  std::vector<float> nx(x.size(), 7.0F), ny(nx), nz(nx);
  look_up(field, LookUp::trilinear, {x, middle, middle}, {{}, nx, ny, nz});
  const std::vector<float> expected{-1, -1, 0, 0, 0, 1, 1};
  for (std::size_t p = 0; p < x.size(); ++p) {
    INFO("x = " << x[p]);
    CHECK(nx[p] == Approx(expected[p]));
    CHECK(ny[p] == 0);
    CHECK(nz[p] == 0);
  }
}

/// The greatest difference of voxels that touch, at faces, edges or corners.
float jump_by_brute_force(const Field& field) {
  const auto [nx, ny, nz] = field.grid.n;
  float largest = 0;
  for (int at = 0; at < nx * ny * nz; ++at)
    for (int way = 0; way < 27; ++way) {
      const int i = at % nx, j = at / nx % ny, k = at / (nx * ny);
      const int u = i + way % 3 - 1, v = j + way / 3 % 3 - 1, w = k + way / 9 - 1;
      if (u < 0 || v < 0 || w < 0 || u >= nx || v >= ny || w >= nz) continue;
      largest = std::max(largest, std::fabs(field.distance[field.grid.index(i, j, k)] -
                                            field.distance[field.grid.index(u, v, w)]));
    }
  return largest;
}

TEST_CASE("no two voxels that touch differ by more than the field's jump, however it was made",
          "[dn_field]") {
  const Surface box = make_box({0.5, 0.3, 0.2});
  const Grid grid = grid_around(bounds(box), 19, 0.3);
  std::vector<Field> fields{build_field(box, grid)};
  for (const double thickness : {HUGE_VAL, 3 * grid.cell})
    for (const Method method : {Method::normals, Method::potential})
      fields.push_back(build_field(
          box, grid, {Sides::one, Content::distance_and_normal, thickness, method, {}}));
  for (const Field& field : fields) {
    CHECK(field.jump == jump_by_brute_force(field));
    CHECK(static_cast<double>(field.jump) < 1.7321 * grid.cell);
  }
  const Field compressed = compress(fields[0], {0.2 * grid.cell, 0.1});
  CHECK(compressed.jump == fields[0].jump);
}

TEST_CASE("the jump is that of brute force on grids of any size", "[dn_field]") {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> edge(1, 21);
  std::normal_distribution<float> distance;
  for (int i = 0; i < 200; ++i) {
    Field field;
    field.grid = {
        {}, 1, {edge(random), i % 5 == 0 ? 1 : edge(random), i % 7 == 0 ? 1 : edge(random)}};
    for (std::size_t at = 0; at < field.grid.size(); ++at)
      field.distance.push_back(std::exp(distance(random)) * distance(random));
    if (i % 3 == 0) field.distance[field.grid.size() / 2] = std::nanf("");
    CHECK(greatest_jump(field) == jump_by_brute_force(field));
  }
}

}  // namespace
