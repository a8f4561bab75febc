#include "collide/pairs.hpp"
#include "collide/tetrahedron.hpp"
#include "tests/collide/shapes/oracle.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

std::vector<Point> corners_of(const Aabb& box) {
  std::vector<Point> out;
  for (const double x : {box.lo[0], box.hi[0]})
    for (const double y : {box.lo[1], box.hi[1]})
      for (const double z : {box.lo[2], box.hi[2]}) out.push_back({x, y, z});
  return out;
}

}  // namespace

TEST_CASE(
    "boxes with triangles, segments and tetrahedra, as the oracle says, degenerate ones alike",
    "[collide][shapes]") {
  SmallPoints random(3);
  std::array<std::array<int, 2>, 2> n{};
  for (int i = 0; i < 4000; ++i) {
    const int size = 3 + i % 6;
    Aabb box = merged(box_of(random.point(size)), box_of(random.point(size)));
    if (i % 5 == 0) box.hi[random.below(3)] = box.lo[random.below(3)];  // may be inside out
    for (std::size_t k = 0; k < 3; ++k)
      if (box.hi[k] < box.lo[k]) std::swap(box.lo[k], box.hi[k]);
    Tetrahedron t{random.points<4>(size)};
    if (i % 7 == 0) t.corners[3] = t.corners[2];
    if (i % 7 == 1) t.corners[2] = t.corners[1];
    if (i % 7 == 2) t.corners[0] = box.lo;
    if (i % 7 == 3)
      for (Point& corner : t.corners) corner[2] = box.lo[2];
    const Triangle triangle{{t.corners[0], t.corners[1], t.corners[2]}};
    const Segment segment{t.corners[0], t.corners[1]};
    const std::vector<Point> corners = corners_of(box);
    for (const Touching touching : both) {
      CAPTURE(i, static_cast<int>(touching));
      const bool expected = oracle(corners, triangle.corners, touching);
      REQUIRE(intersect(box, triangle, touching) == expected);
      REQUIRE(intersect(triangle, box, touching) == expected);
      REQUIRE(intersect(box, segment, touching) ==
              oracle(corners, std::array{segment.from, segment.to}, touching));
      REQUIRE(intersect(box, t, touching) == oracle(corners, t.corners, touching));
      ++n[touching == Touching::counts ? 1U : 0U][expected ? 1U : 0U];
    }
  }
  CHECK(n[1][0] > 300);
  CHECK(n[0][1] > 300);
}

TEST_CASE("a triangle that touches a face of a box is decided to the last bit",
          "[collide][shapes]") {
  const Aabb box{{0, 0, 0}, {0.1, 0.2, 0.3}};
  for (const double up : {std::nextafter(0.3, 0), 0.3, std::nextafter(0.3, 1)}) {
    const Triangle above{{Point{-1, -1, up}, Point{3, -1, up}, Point{-1, 3, up}}};
    CHECK(intersect(box, above, Touching::counts) == (up <= 0.3));
    CHECK(intersect(box, above, Touching::does_not_count) == (up < 0.3));
  }
  // A slanted plane through the corner (0.1, 0.2, 0.3): x / 0.1 + y / 0.2 = 2 at every height.
  const auto slanted = [](double x) {
    return Triangle{{Point{x, 0, -1}, Point{0, 2 * x, -1}, Point{x, 0, 7}}};
  };
  CHECK(intersect(box, slanted(0.2), Touching::counts));
  CHECK_FALSE(intersect(box, slanted(0.2), Touching::does_not_count));
  CHECK_FALSE(intersect(box, slanted(std::nextafter(0.2, 1)), Touching::counts));
  CHECK(intersect(box, slanted(std::nextafter(0.2, 0)), Touching::does_not_count));
}

TEST_CASE("pairs() of boxes and triangles", "[collide][shapes]") {
  SmallPoints random(4);
  std::vector<Aabb> boxes;
  std::vector<Triangle> triangles;
  for (int i = 0; i < 60; ++i) {
    boxes.push_back(merged(box_of(random.point(9)), box_of(random.point(9))));
    triangles.push_back({random.points<3>(12)});
  }
  std::size_t n = 0;
  for (const Aabb& box : boxes)
    for (const Triangle& triangle : triangles)
      n += oracle(corners_of(box), triangle.corners, Touching::counts) ? 1U : 0U;
  CHECK(n > 100);
  CHECK(count_pairs(std::span<const Aabb>(boxes), std::span<const Triangle>(triangles)) == n);
}
