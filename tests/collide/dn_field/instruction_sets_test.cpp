#include "collide/dn_field/made_field.hpp"
#include "tests/collide/dn_field/plain_lanes.hpp"
#include "tests/support/catch.hpp"

#include <cstring>
#include <random>

namespace {

using namespace tess::dn;

TEST_CASE("look-ups have the same bits with and without vector instructions",
          "[dn_field][look_up]") {
  Field unit = sphere_field(cube_grid(1, 17), 0.6);
  unit.grid.origin = {};
  unit.grid.cell = 1;  // grid coordinates are the object's own
  std::mt19937 random(1);
  std::uniform_real_distribution<float> anywhere(-1, 18);
  std::vector<float> points(3 * plain::sample_count);
  for (float& value : points) value = anywhere(random);
  points[7] = std::nanf("");
  for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
    std::vector<float> plain_out(4 * plain::sample_count), out(4 * plain::sample_count);
    const std::size_t n = plain::sample_count;
    plain::samples(unit, kind, points.data(), plain_out.data());
    look_up(unit, kind, {{&points[0], n}, {&points[n], n}, {&points[2 * n], n}},
            {{&out[0], n}, {&out[n], n}, {&out[2 * n], n}, {&out[3 * n], n}});
    CHECK(std::memcmp(out.data(), plain_out.data(), out.size() * sizeof(float)) == 0);
  }
}

TEST_CASE("the rules have the same bits with and without vector instructions",
          "[dn_field][rules]") {
  RuleConstants c;
  c.step = 0.01;
  c.air = {0.99, 0.00995, 0.00995, 5e-5};
  c.surface = {0.9, 0.0095, 0.0095, 5e-5};
  c.acceleration = {0.1, 0, -1};
  c.surface_rate = 10, c.surface_threshold = 0.2;
  c.restitution = 0.7, c.threshold = 0.01, c.slack = 1e-4, c.stride = 0.01;
  c.flow = {0.01, -0.02, 0.3};
  c.spring = {1e4, 99, 10, 0.1};
  const auto nearest = std::make_unique<NearestSurface>();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  Particles wide, narrow;
  for (std::size_t p = 0; p < block_size; ++p) {
    const auto any = [&] { return Vec3{anywhere(random), anywhere(random), anywhere(random)}; };
    const Vec3 n = p % 17 == 0 ? Vec3{} : direction(any()), u = any();
    wide.push_back(any(), 3 * any());
    nearest->distance[p] = static_cast<float>(0.3 * anywhere(random));
    nearest->free[p] = nearest->distance[p];
    nearest->nx[p] = static_cast<float>(n.x), nearest->ny[p] = static_cast<float>(n.y);
    nearest->nz[p] = static_cast<float>(n.z);
    nearest->ux[p] = u.x, nearest->uy[p] = u.y, nearest->uz[p] = u.z;
  }
  narrow = wide;
  const auto a = std::make_unique<Scratch>(), b = std::make_unique<Scratch>();
  turn_to_surface(c.flow, Setting::general, wide.span(), *nearest);
  rule_loop_general({Flight{true, Drags::surface}, Impacts::swept, Springs::exact})(c, wide.span(),
                                                                                    *nearest, *a);
  plain::loop(c, narrow.span(), *nearest, *b);
  const auto same = [](const Values& x, const Values& y) {
    return std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
  };
  CHECK(same(wide.x, narrow.x));
  CHECK(same(wide.y, narrow.y));
  CHECK(same(wide.z, narrow.z));
  CHECK(same(wide.vx, narrow.vx));
  CHECK(same(wide.vy, narrow.vy));
  CHECK(same(wide.vz, narrow.vz));
  CHECK(std::memcmp(a->energy, b->energy, sizeof a->energy) == 0);
  CHECK(a->untraced.size() == b->untraced.size());
  CHECK(a->untraced.size() > 10);
}

}  // namespace
