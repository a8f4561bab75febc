// The step loop in compressed fields. The oracles: the scalar look-up, the flat field where the
// bound is zero, and the closed form of a bounce within the bound where it is not.
#include "collide/dn_field/field/compressed_sample.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/stepper.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <cstring>
#include <random>

namespace {

using namespace tess::dn;

Field ball_field(int n) {
  Field field = sphere_field(cube_grid(1.5, n), 0.6);
  field.thickness = 4;
  return field;
}

Particles crowd_of(std::size_t count, double speed) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  const auto vector = [&] { return Vec3{any(random), any(random), any(random)}; };
  Particles particles;
  for (std::size_t p = 0; p < count; ++p) {
    const Vec3 x = vector();
    particles.push_back(x, speed * vector());
  }
  return particles;
}

bool same_bits(const Particles& a, const Particles& b) {
  const auto bits = [](const Values& u, const Values& v) {
    return u.size() == v.size() && std::memcmp(u.data(), v.data(), u.size() * sizeof(double)) == 0;
  };
  return bits(a.x, b.x) && bits(a.y, b.y) && bits(a.z, b.z) && bits(a.vx, b.vx) &&
         bits(a.vy, b.vy) && bits(a.vz, b.vz);
}

TEST_CASE("eight look-ups at once have the bits of one by one", "[dn_field][compressed]") {
  Field field = ball_field(21);
  field.grid.origin = {};
  field.grid.cell = 1;  // grid coordinates are the object's own
  for (float& distance : field.distance) distance *= 20 / 3.0F;
  field.thickness = 40;
  for (const ErrorBound bound : {ErrorBound{0.125, 0.05}, ErrorBound{0.05, 0.02}}) {
    const Field compressed = compress(field, bound);
    const PlaneSampler sampler = plane_sampler_of(compressed);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1, 22);
    for (int round = 0; round < 300; ++round) {
      std::array<float, lanes::width> x{}, y{}, z{}, d{}, nx{}, ny{}, nz{};
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = place(random), y[i] = place(random), z[i] = place(random);
      if (round == 0) y[3] = std::nanf("");
      look_up(compressed, LookUp::nearest, {x, y, z}, {d, nx, ny, nz});
      const Sample found = lanes::sample<LookUp::nearest, Ask::both>(
          sampler, {lanes::load<lanes::F>(x.data()), lanes::load<lanes::F>(y.data()),
                    lanes::load<lanes::F>(z.data())});
      const lanes::F distance = found.distance_or_far();
      for (int i = 0; i < lanes::width; ++i) {
        const auto at = static_cast<std::size_t>(i);
        CHECK(distance[i] == d[at]);
        CHECK(found.normal.x[i] == nx[at]);
        CHECK(found.normal.y[i] == ny[at]);
        CHECK(found.normal.z[i] == nz[at]);
      }
    }
    for (int k = 0; k < 21; k += 4)
      for (int i = 0; i < 21; ++i)
        CHECK(std::abs(voxel_distance(compressed, i, 7, k) -
                       field.distance[field.grid.index(i, 7, k)]) <= bound.distance * 1.00001);
  }
}

Rules surface_rules(LookUp kind, Sweep sweep) {
  Rules rules;
  rules.look_up = kind;
  rules.spring = Spring{50, 1, 0.1};
  rules.impact = Impact{0.7, 0.01, sweep};
  rules.surface_drag = SurfaceDrag{0.5, 0.2};
  rules.surface_flow = SurfaceFlow{1, 2, 0.3};
  rules.gravity = Gravity{{0, 0, -1}};
  return rules;
}

TEST_CASE("in fields compressed without loss particles move as in flat ones, bit for bit",
          "[dn_field][compressed]") {
  // All distances are multiples of a 16th, and so is the step of the entries' distances.
  Field flat = plane_field({{-1.5, -1.5, -1.5}, 0.125, {25, 25, 25}}, {0, 0, 1});
  flat.thickness = 511.0 / 16 - 8 * flat.grid.cell;
  const Field compressed = compress(flat, {0, 0}, 2);
  CHECK(compressed.planes->layout.step == 1.0F / 16);
  for (const LookUp kind : {LookUp::nearest, LookUp::tangent})
    for (const Sweep sweep : {Sweep::off, Sweep::on})
      for (const bool moves : {false, true}) {
        std::vector<Object> one{{&flat, {}}}, other{{&compressed, {}}};
        if (moves) {
          for (std::vector<Object>* objects : {&one, &other}) {
            objects->push_back(objects->front());
            Frame& frame = objects->back().frame;
            frame.position = {1.2, 0.3, 0};
            frame.scale = 0.5;
            frame.angular_velocity = {1, 2, 0};
            frame.velocity = {0, 0.5, 0};
          }
        }
        Rules rules = surface_rules(kind, sweep);
        if (kind == LookUp::nearest) rules.spring.reset();
        validate(rules, one);
        validate(rules, other);
        const Stepper stepper = make_stepper(rules, 0.02);
        Particles a = crowd_of(1003, 2), b = crowd_of(1003, 2);
        stepper.run(a.span(), one, 0, 50);
        stepper.run(b.span(), other, 0, 50);
        CHECK(same_bits(a, b));
      }
}

TEST_CASE("in a compressed field nothing passes at any speed, and bounces are off by the bound",
          "[dn_field][compressed]") {
  Field wall = plane_field(cube_grid(1, 33), {0, 0, 1});
  wall.thickness = 2;
  const double cell = wall.grid.cell;
  const Field compressed = compress(wall, {0.125 * cell, 0.05});
  CHECK(compressed.bytes() * 5 < wall.bytes());
  Rules rules;
  rules.impact = Impact{1, 0, Sweep::on};
  const std::array objects{Object{&compressed, {}}};
  for (const double speed : {0.5, 50.0, 5e4}) {
    Particles particles;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0.05, 0.9);
    for (int i = 0; i < 100; ++i)
      particles.push_back({0.5 * any(random), -0.5 * any(random), any(random)}, {0, 0, -speed});
    const Particles before = particles;
    const int n_steps = 20;
    const double step = 2.0 / (n_steps * speed);
    make_stepper(rules, step).run(particles.span(), objects, 0, n_steps);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      CHECK(particles.velocity(p).z == Approx(speed).epsilon(1e-2));
      // Down to the wall and up again: 2 in all.
      const double off = particles.position(p).z - (2 - before.position(p).z);
      CHECK(std::abs(off) <= 2 * (compressed.planes->measured.distance + 0.05 * cell));
    }
  }
}

TEST_CASE("compressed fields that cannot serve are refused with a reason",
          "[dn_field][compressed]") {
  const Field flat = ball_field(12), compressed = compress(flat, {0.01, 0.05});
  const auto refusal = [](const Rules& rules, std::vector<Object> objects) {
    return tess::test::message_of([&] { validate(rules, objects); });
  };
  const Rules tangent = surface_rules(LookUp::tangent, Sweep::on);
  CHECK(refusal(tangent, {{&compressed, {}}}).empty());
  CHECK_THAT(refusal(surface_rules(LookUp::trilinear, Sweep::on), {{&compressed, {}}}),
             Contains("trilinear"));
  CHECK_THAT(refusal(tangent, {{&compressed, {}}, {&flat, {}}}), Contains("compress all"));
  Field distances = flat;
  distances.normal = {};
  CHECK_THAT(refusal(tangent, {{&distances, {}}}), Contains("no normals"));
  CHECK_THROWS_WITH(compress(distances, {0.01, 0.05}), Contains("without normals"));
  CHECK_THROWS_WITH(compress(compressed, {0.01, 0.05}), Contains("is compressed already"));
}

}  // namespace
