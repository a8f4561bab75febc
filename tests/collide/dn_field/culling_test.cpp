#include "collide/dn_field/step/culling.hpp"

#include "tests/support/catch.hpp"

#include <memory>
#include <random>
#include <vector>

namespace {

using namespace tess::dn;

/// The distances and normals of a ball with noise, which belong to no surface, around `middle`.
Field noisy(double noise, std::mt19937& random, Vec3 middle = {}) {
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
  field.grid.origin += middle;
  field.jump = greatest_jump(field);
  return field;
}

Vec3 middle_of(const Field& field) {
  return field.grid.origin + 0.5 * (field.grid.n[0] - 1) * field.grid.cell * Vec3{1, 1, 1};
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
Culled culled(const Field& field, LookUp kind, int steps, float reach, std::mt19937& random,
              const Frame& frame = {}) {
  std::uniform_real_distribution<double> anywhere(-1, 1);
  constexpr double step = 0.02;
  const bool moves = frame.is_moving();
  const float time = static_cast<float>(steps * step);
  std::vector<Frame> frames{frame};  // at the start of each step
  while (std::ssize(frames) < steps) {
    frames.push_back(frames.back());
    frames.back().advance(step);
  }
  const PlacedObject placed_there = placed({&field, frame}, kind, step, moves, 0);
  const auto near = std::make_unique<NearParticles>();
  Culled result;
  for (int block = 0; block < 8; ++block) {
    Particles particles;
    for (std::size_t p = 0; p < block_size; ++p) {
      // Slow ones in the way of an object that moves, and others that are far from it.
      const double spread = !moves ? 1.1 : p % 2 == 0 ? 1.2 : 3, speed = moves ? 0.1 : 1;
      particles.push_back(frame.to_world(middle_of(field)) +
                              spread * Vec3{anywhere(random), anywhere(random), anywhere(random)},
                          speed * Vec3{anywhere(random), anywhere(random), anywhere(random)});
    }
    cull({&placed_there, 1}, kind, Sweep::off, {reach, time, 0, steps > 1}, particles.span(),
         *near);
    std::array<bool, block_size> listed{};
    for (std::size_t i = 0; i < near->count; ++i) listed[near->index[i]] = true;
    for (std::size_t p = 0; p < block_size; ++p) {
      if (listed[p]) continue;
      ++result.far;
      for (int i = 0; i < steps; ++i) {
        const Vec3 x = particles.position(p) + i * step * particles.velocity(p);
        const Frame& now = frames[static_cast<std::size_t>(i)];
        result.nearest = std::min(result.nearest, static_cast<float>(now.scale) *
                                                      look_up_at(field, kind, now.to_object(x)));
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

TEST_CASE("a particle that is culled from objects that turn and fly is near by no sample",
          "[dn_field][rules]") {
  std::mt19937 random(6);
  constexpr float reach = 0.1F;
  std::vector<Frame> frames(3);
  frames[0].angular_velocity = {0, 0, 0.3};
  frames[1].velocity = {-2, 1, 0.5};
  frames[2].angular_velocity = {0.2, -0.2, 0.1};
  frames[2].velocity = {1, 0, -1};
  frames[2].axes = rotation({0.3, -1, 0.4});
  frames[2].scale = 0.7;
  // The second field is far from the origin around which its object turns.
  for (const Vec3 middle : {Vec3{}, Vec3{20, -4, 3}})
    for (const Frame& frame : frames)
      for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
        for (const int steps : {1, 4, 8}) {
          const Field field = noisy(0.02, random, middle);
          const Culled found = culled(field, kind, steps, reach, random, frame);
          INFO("frame " << &frame - frames.data() << ", look-up " << static_cast<int>(kind)
                        << ", steps " << steps << ", middle " << middle.x);
          CHECK(found.nearest > reach);
          CHECK(found.far > 10);
        }
}

}  // namespace
