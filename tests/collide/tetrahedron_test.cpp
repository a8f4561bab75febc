#include "collide/tetrahedron.hpp"

#include "tests/collide/shapes/oracle.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

/// Random corners; some in one plane, some with equal corners.
Tetrahedron some_tetrahedron(SmallPoints& random, int size, std::size_t kind) {
  Tetrahedron t{random.points<4>(size)};
  if (kind % 8 == 1)
    for (Point& p : t.corners) p[kind / 8 % 3] = 1;
  if (kind % 8 == 2) t.corners[3] = t.corners[0];
  if (kind % 8 == 3)
    for (Point& p : t.corners) p[2] = p[0] + p[1];
  if (kind % 64 == 4) t.corners[3] = t.corners[2] = t.corners[1];
  if (kind % 64 == 5) t.corners.fill(t.corners[0]);
  return t;
}

Tetrahedron scaled(Tetrahedron t, int power, double offset) {
  for (Point& p : t.corners)
    for (double& x : p) x = std::ldexp(x, power) + offset;
  return t;
}

}  // namespace

TEST_CASE("tetrahedra intersect as the oracle says, degenerate ones alike", "[collide][shapes]") {
  SmallPoints random(1);
  std::array<std::array<int, 2>, 2> n{};
  for (std::size_t i = 0; i < 6'000; ++i) {
    const int size = 2 + int(i % 4);
    const Tetrahedron a = some_tetrahedron(random, size, i / 4);
    Tetrahedron b = some_tetrahedron(random, size, random.below(64));
    if (i % 9 == 0) b.corners[1] = a.corners[2];
    if (i % 9 == 1)
      for (Point& p : b.corners) p[1] += size - 1;  // below a's box, touching it
    for (const Touching touching : both) {
      const bool expected = oracle(a.corners, b.corners, touching);
      INFO(i);
      REQUIRE(intersect(a, b, touching) == expected);
      REQUIRE(intersect(b, a, touching) == expected);
      REQUIRE(intersect(scaled(a, 0, 1e12), scaled(b, 0, 1e12), touching) == expected);
      REQUIRE(intersect(scaled(a, -30, 0), scaled(b, -30, 0), touching) == expected);
      if (expected) REQUIRE(overlap(box_of(a), box_of(b), touching));
      ++n[touching == Touching::counts ? 1U : 0U][expected ? 1U : 0U];
    }
  }
  CHECK(n[1][0] > 500);
  CHECK(n[1][1] > 500);
  CHECK(n[0][1] > 500);
}

TEST_CASE("triangles, segments and points in tetrahedra, as the oracle says", "[collide][shapes]") {
  SmallPoints random(2);
  std::array<std::array<int, 2>, 2> n{};
  for (std::size_t i = 0; i < 8'000; ++i) {
    const int size = 3 + int(i % 4);
    const Tetrahedron t = some_tetrahedron(random, size, i / 4);
    Triangle triangle{random.points<3>(size)};
    if (i % 7 == 0) triangle.corners[2] = triangle.corners[1];
    if (i % 7 == 1) triangle.corners[0] = t.corners[0];
    const Segment segment{triangle.corners[0], triangle.corners[1]};
    const std::array ends{segment.from, segment.to};
    const Point& point = triangle.corners[0];
    for (const Touching touching : both) {
      INFO(i);
      const bool expected = oracle(t.corners, triangle.corners, touching);
      REQUIRE(intersect(t, triangle, touching) == expected);
      REQUIRE(intersect(triangle, t, touching) == expected);
      REQUIRE(intersect(t, segment, touching) == oracle(t.corners, ends, touching));
      REQUIRE(intersect(segment, t, touching) == oracle(t.corners, ends, touching));
      REQUIRE(intersect(t, point, touching) == oracle(t.corners, {&point, 1}, touching));
      REQUIRE(intersect(point, t, touching) == oracle(t.corners, {&point, 1}, touching));
      REQUIRE(intersect(segment, triangle, touching) == oracle(ends, triangle.corners, touching));
      REQUIRE(intersect(triangle, t.corners[3], touching) ==
              oracle(triangle.corners, {&t.corners[3], 1}, touching));
      REQUIRE(intersect(segment, Segment{t.corners[1], t.corners[2]}, touching) ==
              oracle(ends, std::array{t.corners[1], t.corners[2]}, touching));
      ++n[touching == Touching::counts ? 1U : 0U][expected ? 1U : 0U];
    }
  }
  CHECK(n[1][0] > 500);
  CHECK(n[0][1] > 500);
}

TEST_CASE("a point on a face touches, and one ulp off it does not", "[collide][shapes]") {
  const Tetrahedron t{{Point{0, 0, 0}, Point{0.3, 0, 0}, Point{0, 0.7, 0}, Point{0, 0, 1.1}}};
  const double least = std::numeric_limits<double>::denorm_min();
  CHECK(intersect(t, Point{0.1, 0.1, 0}, Touching::counts));
  CHECK_FALSE(intersect(t, Point{0.1, 0.1, 0}, Touching::does_not_count));
  CHECK(intersect(t, Point{0.1, 0.1, least}, Touching::does_not_count));
  CHECK_FALSE(intersect(t, Point{0.1, 0.1, -least}, Touching::counts));
}
