// Pairs of capsules at a known distance.
#include "collide/problem/slim_capsule.hpp"

#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <vector>

using namespace tess::collide;
using namespace tess::collide::search;

namespace {

/// Pairs of capsules (2 i and 2 i + 1) whose segments have a distance of `gap` times both radii.
struct Crossing {
  Frame frame;
  std::vector<SlimCapsule> capsules;
  std::vector<std::uint32_t> in_a, in_b;
};

Crossing crossing(std::uint64_t seed, double offset, double scale, double radius, double gap) {
  tess::Random random(seed);
  const Point lo{offset - scale, offset - scale, offset - scale},
      hi{offset + scale, offset + scale, offset + scale};
  Crossing scene{frame_of({lo, hi}), {}, {}, {}};
  for (std::uint32_t i = 0; i < 200; ++i) {
    Point u{}, v{}, n{}, at{};
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = random.unit() - 0.5;
      v[k] = random.unit() - 0.5;
      at[k] = 0.4 * (random.unit() - 0.5);
    }
    for (std::size_t k = 0; k < 3; ++k)
      n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    const double length = std::hypot(n[0], n[1], n[2]);
    Capsule a{{}, {}, radius * scale}, b{{}, {}, radius * scale};
    const double from = 0.5 * random.unit(), to = 0.5 * random.unit();
    for (std::size_t k = 0; k < 3; ++k) {
      const double away = gap * radius * n[k] / length;
      a.from[k] = offset + scale * (at[k] - away - from * u[k]);
      a.to[k] = offset + scale * (at[k] - away + to * u[k]);
      b.from[k] = offset + scale * (at[k] + away - to * v[k]);
      b.to[k] = offset + scale * (at[k] + away + from * v[k]);
    }
    scene.in_a.push_back(2 * i);
    scene.in_b.push_back(2 * i + 1);
    scene.capsules.push_back(slim(a, scene.frame));
    scene.capsules.push_back(slim(b, scene.frame));
  }
  return scene;
}

std::vector<std::uint32_t> kept(const Crossing& scene, std::size_t begin, std::size_t n) {
  std::vector<std::uint32_t> out(n + 8);
  out.resize(may_meet(scene.capsules.data(), scene.capsules.data(), scene.in_a.data() + begin,
                      scene.in_b.data() + begin, n, out.data()));
  return out;
}

}  // namespace

TEST_CASE("capsules that touch are kept, and capsules that are twice as far apart are rejected",
          "[capsule]") {
  for (const double offset : {0.0, 3.0, 1e6})
    for (const double scale : {1.0, 1e9, 1e-9, 1e-300, 1e300})
      for (const double radius : {0.01, 1e-4}) {
        if (offset != 0 && scale != 1) continue;
        CAPTURE(offset, scale, radius);
        REQUIRE(kept(crossing(1, offset, scale, radius, 1 - 1e-6), 0, 200).size() == 200);
        REQUIRE(kept(crossing(1, offset, scale, radius, 2), 0, 200).size() <= 10);
      }
}

TEST_CASE("the last pairs of a list are compared like the others", "[capsule]") {
  const Crossing scene = crossing(2, 0, 1, 0.02, 1.2);
  std::vector<bool> keeps;
  for (std::size_t i = 0; i < 200; ++i) keeps.push_back(kept(scene, i, 1).size() == 1);
  for (const std::size_t begin : {std::size_t{0}, std::size_t{3}})
    for (std::size_t n = 0; n < 60; ++n) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t m = 0; m < n; ++m)
        if (keeps[begin + m]) expected.push_back(m);
      REQUIRE(kept(scene, begin, n) == expected);
    }
}

TEST_CASE("parallel capsules, points, and capsules of which nothing is known are kept",
          "[capsule]") {
  const Frame frame = frame_of({{0, 0, 0}, {1, 1, 1}});
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Crossing scene{frame, {slim({{0, 0, 0}, {1, 1, 1}, 0}, frame)}, {}, {}};
  for (const Capsule& other :
       {Capsule{{0, 0, 0.5}, {0.5, 0.5, 1}, 0}, Capsule{{1, 0, 0}, {1, 0, 0}, 0},
        Capsule{{1, 0, 0}, {1, 0.1, 0}, inf}, Capsule{{1, 0, 0}, {1, 0.1, 0}, nan},
        Capsule{{1, 0, 0}, {1e7, 0.1, 0}, 0}, Capsule{{1, nan, 0}, {1, 0, 0}, 0}}) {
    scene.capsules.push_back(slim(other, frame));
    scene.in_a.push_back(0);
    scene.in_b.push_back(static_cast<std::uint32_t>(scene.capsules.size() - 1));
  }
  REQUIRE(kept(scene, 0, scene.in_a.size()).size() == scene.in_a.size());
}
