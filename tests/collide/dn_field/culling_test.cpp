#include "collide/dn_field/step/culling.hpp"

#include "tests/support/catch.hpp"

#include <memory>
#include <random>

namespace {

using namespace tess::dn;

/// The distances and normals of a ball with noise, which belong to no surface.
Field noisy(double noise, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Field field;
  constexpr int n = 20;
  constexpr double cell = 2.0 / n;
  field.grid = {{-1 + 0.5 * cell, -1 + 0.5 * cell, -1 + 0.5 * cell}, cell, {n, n, n}};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 x = field.grid.origin + cell * Vec3{1.0 * i, 1.0 * j, 1.0 * k};
        field.distance.push_back(static_cast<float>(norm(x) - 0.3 + noise * normal(random)));
        field.normal.push_back(encode_normal({normal(random), normal(random), normal(random)}));
      }
  field.jump = greatest_jump(field);
  return field;
}

float look_up_at(const Field& field, LookUp kind, Vec3 x) {
  const std::array at{static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
  float distance = 0;
  look_up(field, kind, {{&at[0], 1}, {&at[1], 1}, {&at[2], 1}}, {{&distance, 1}, {}, {}, {}});
  return distance;
}

/// The least distance sampled on the paths of culled particles over `steps` steps.
struct Culled {
  int far = 0;
  float nearest = out_of_reach;
};
Culled culled(const Field& field, LookUp kind, int steps, float reach, std::mt19937& random) {
  std::uniform_real_distribution<double> anywhere(-1, 1);
  constexpr double step = 0.02;
  const float time = static_cast<float>(steps * step);
  const Object object{&field, {}};
  const PlacedObject standing = placed(object, kind, step, false);
  const auto near = std::make_unique<NearParticles>();
  Culled result;
  for (int block = 0; block < 8; ++block) {
    Particles particles;
    for (std::size_t p = 0; p < block_size; ++p)
      particles.push_back(1.1 * Vec3{anywhere(random), anywhere(random), anywhere(random)},
                          Vec3{anywhere(random), anywhere(random), anywhere(random)});
    cull({&standing, 1}, kind, Sweep::off, {reach, time, 0, steps > 1}, particles.span(), *near);
    std::array<bool, block_size> listed{};
    for (std::size_t i = 0; i < near->count; ++i) listed[near->index[i]] = true;
    for (std::size_t p = 0; p < block_size; ++p) {
      if (listed[p]) continue;
      ++result.far;
      for (int i = 0; i < steps; ++i) {
        const Vec3 x = particles.position(p) + i * step * particles.velocity(p);
        result.nearest = std::min(result.nearest, look_up_at(field, kind, x));
      }
    }
  }
  return result;
}

TEST_CASE("a culled particle is near by no sample on its path", "[dn_field][rules]") {
  std::mt19937 random(5);
  constexpr float reach = 0.1F;
  for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
    for (const int steps : {1, 8}) {
      int far = 0;
      for (const double noise : {0.0, 0.02, 0.05, 0.3}) {
        const Field field = noisy(noise, random);
        const Culled found = culled(field, kind, steps, reach, random);
        INFO("noise " << noise << ", look-up " << static_cast<int>(kind) << ", steps " << steps);
        CHECK(found.nearest > reach);
        far += found.far;
      }
      CHECK(far > 300);
    }
}

}  // namespace
