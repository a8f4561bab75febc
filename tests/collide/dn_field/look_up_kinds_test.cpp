#include "apps/kit/worst.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/made_field.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <random>

namespace {

using namespace tess::dn;

struct Asked {
  std::vector<float> x, y, z, distance, nx, ny, nz;

  explicit Asked(std::size_t n) : x(n), y(n), z(n), distance(n), nx(n), ny(n), nz(n) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> anywhere(-1, 1);
    for (std::size_t p = 0; p < n; ++p)
      x[p] = anywhere(random), y[p] = anywhere(random), z[p] = anywhere(random);
  }
  [[nodiscard]] Vec3 point(std::size_t p) const { return vec(x[p], y[p], z[p]); }
  [[nodiscard]] Vec3 normal(std::size_t p) const { return vec(nx[p], ny[p], nz[p]); }
  static Vec3 vec(float a, float b, float c) {
    return {static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)};
  }
  void look_up(const Field& field, LookUp kind) {
    tess::dn::look_up(field, kind, {x, y, z}, {distance, nx, ny, nz});
  }
};

constexpr LookUp kinds[] = {LookUp::nearest, LookUp::tangent, LookUp::trilinear};

TEST_CASE("tangent and trilinear look-ups of a plane are exact", "[dn_field][look_up]") {
  const Vec3 normal = direction({1, -2, 3});
  const Field field = plane_field(cube_grid(1.25, 21), normal);
  Asked asked(503);
  for (const LookUp kind : kinds) {
    asked.look_up(field, kind);
    double worst = 0, turned = 0;
    for (std::size_t p = 0; p < asked.x.size(); ++p) {
      kit::worsen(worst,
                  std::abs(static_cast<double>(asked.distance[p]) - dot(normal, asked.point(p))));
      kit::worsen(turned, norm(asked.normal(p) - normal));
    }
    CHECK(worst < (kind == LookUp::nearest ? 0.87 * field.grid.cell : 1e-5));
    CHECK(turned < 1e-4);
  }
}

TEST_CASE("off the medial axis errors fall with the cell: order 1 by nearest, 2 by the others",
          "[dn_field][look_up]") {
  Asked asked(4000);
  for (const LookUp kind : kinds) {
    double error[2], turned[2];
    for (const int fine : {0, 1}) {
      const Field field = sphere_field(cube_grid(1.25, fine != 0 ? 81 : 41), 0.7);
      asked.look_up(field, kind);
      error[fine] = turned[fine] = 0;
      for (std::size_t p = 0; p < asked.x.size(); ++p) {
        const Vec3 at = asked.point(p);
        if (norm(at) < 0.4) continue;
        kit::worsen(error[fine],
                    std::abs(static_cast<double>(asked.distance[p]) - (norm(at) - 0.7)));
        kit::worsen(turned[fine], norm(asked.normal(p) - direction(at)));
        CHECK(std::abs(norm(asked.normal(p)) - 1) < 1e-6);
      }
    }
    INFO(error[0] << " " << error[1] << ", " << turned[0] << " " << turned[1]);
    CHECK(error[0] / error[1] > (kind == LookUp::nearest ? 1.5 : 2.9));
    CHECK(turned[0] / turned[1] > (kind == LookUp::trilinear ? 2.9 : 1.5));
  }
}

TEST_CASE("distance alone, normal alone and both agree to the bit", "[dn_field][look_up]") {
  Field field = sphere_field(cube_grid(0.9, 20), 0.5);  // some points are outside
  for (const LookUp kind : kinds) {
    Asked both(101), single(101);
    both.look_up(field, kind);
    look_up(field, kind, {single.x, single.y, single.z}, {single.distance, {}, {}, {}});
    look_up(field, kind, {single.x, single.y, single.z}, {{}, single.nx, single.ny, single.nz});
    CHECK(both.distance == single.distance);
    CHECK(both.nx == single.nx);
    CHECK(both.ny == single.ny);
    CHECK(both.nz == single.nz);
  }
  field.normal.clear();
  Asked asked(8);
  CHECK_THROWS_AS(asked.look_up(field, LookUp::nearest), tess::Error);
  CHECK_THROWS_AS(
      look_up(field, LookUp::tangent, {asked.x, asked.y, asked.z}, {asked.distance, {}, {}, {}}),
      tess::Error);
}

TEST_CASE("outside, for NaN and between opposite normals there is no normal",
          "[dn_field][look_up]") {
  const Field sheet = sheet_field(cube_grid(1, 20));  // z = 0 lies midway between two layers
  for (const LookUp kind : kinds) {
    Asked asked(3);
    asked.x = {0.1F, 5, std::nanf("")};
    asked.y = {0.1F, 0, 0};
    asked.z = {0, 0, 0};
    asked.look_up(sheet, kind);
    if (kind == LookUp::trilinear) CHECK(norm(asked.normal(0)) == 0);
    for (const std::size_t p : {std::size_t{1}, std::size_t{2}}) {
      CHECK(asked.distance[p] == out_of_reach);
      CHECK(norm(asked.normal(p)) == 0);
    }
  }
}

}  // namespace
