// A point is in a capsule if a ball of the same radius around it meets the segment, which the
// library decides exactly.
#include "collide/capsule.hpp"

#include "collide/sphere.hpp"
#include "collide/swept.hpp"
#include "collide/tetrahedron.hpp"
#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tess::collide;

namespace {

bool contains(const Capsule& capsule, const Point& p) {
  return intersect(Sphere{p, capsule.radius}, Segment{capsule.from, capsule.to}, Touching::counts);
}

}  // namespace

TEST_CASE("the capsule of a shape contains its corners, and is at most sqrt(3) too thick",
          "[capsule]") {
  tess::Random random(3);
  for (const double offset : {0.0, 1.0, 1e12})
    for (const double scale : {1.0, 1e-9, 1e9, 1e-200, 1e-310, 1e100})
      for (const double thick : {1.0, 1e-3, 1e-9, 0.0})
        for (int round = 0; round < 40; ++round) {
          CAPTURE(offset, scale, thick, round);
          const auto point = [&](double size) {
            Point p{};
            for (double& x : p) x = offset + scale * size * (random.unit() - 0.5);
            return p;
          };
          const Point a = point(1), b = round % 8 == 0 ? a : point(1);
          const auto near_line = [&] {
            Point p = point(thick);
            const double share = random.unit();
            for (std::size_t k = 0; k < 3; ++k)
              p[k] += share * (a[k] - offset) + (1 - share) * (b[k] - offset);
            return p;
          };
          const Triangle triangle{{near_line(), a, b}};
          const Capsule capsule = capsule_of(triangle);
          for (const Point& p : triangle.corners) REQUIRE(contains(capsule, p));
          const double size = scale + offset;
          if (scale > 1e-150)  // the squares of smaller ones underflow, so no edge is the longest
            REQUIRE(capsule.radius <= std::sqrt(3) * thick * scale + 1e-14 * size + 1e-300);
          const Tetrahedron tetrahedron{{b, near_line(), a, near_line()}};
          for (const Point& p : tetrahedron.corners) REQUIRE(contains(capsule_of(tetrahedron), p));
        }
}

TEST_CASE("the capsule of a moving box contains it at the start and at the end", "[capsule]") {
  tess::Random random(4);
  for (const double offset : {0.0, -3.0, 1e12})
    for (const double scale : {1.0, 1e-9, 1e9, 1e-200, 1e-310, 1e100})
      for (const double size : {1.0, 1e-3, 1e-9, 0.0})
        for (int round = 0; round < 40; ++round) {
          CAPTURE(offset, scale, size, round);
          const auto box = [&] {
            Aabb out;
            for (std::size_t k = 0; k < 3; ++k) {
              out.lo[k] = offset + scale * (random.unit() - 0.5);
              out.hi[k] = out.lo[k] + scale * size * random.unit();
            }
            return out;
          };
          const Swept<> swept{box(), box()};
          const Capsule capsule = capsule_of(swept);
          double half = 0;
          for (const Aabb& b : {swept.start, swept.end}) {
            half =
                std::max(half, std::hypot((b.hi[0] - b.lo[0]) / scale, (b.hi[1] - b.lo[1]) / scale,
                                          (b.hi[2] - b.lo[2]) / scale) /
                                   2);
            for (unsigned corner = 0; corner < 8; ++corner) {
              Point p;
              for (std::size_t k = 0; k < 3; ++k)
                p[k] = (corner >> k & 1U) != 0 ? b.hi[k] : b.lo[k];
              REQUIRE(contains(capsule, p));
            }
          }
          if (offset == 0)
            REQUIRE(capsule.radius <= scale * half * 1.0000001 + 1e-15 * scale + 1e-300);
        }
}

TEST_CASE("a capsule of coordinates whose differences overflow has no finite radius", "[capsule]") {
  const Swept<> swept{{{-1.7e308, -1e308, -1e308}, {1.7e308, 1.7e308, 1.7e308}},
                      {{0, 0, 0}, {1, 1, 1}}};
  REQUIRE_FALSE(std::isfinite(capsule_of(swept).radius));
  const Triangle triangle{{Point{-1e308, 0, 0}, Point{1.5e308, 1e308, 0}, Point{0, -1e308, 7}}};
  REQUIRE_FALSE(std::isfinite(capsule_of(triangle).radius));
  const Tetrahedron tetrahedron{
      {Point{-1e308, 0, 0}, Point{1.5e308, 1e308, 0}, Point{0, -1e308, 7}, Point{-1e308, 0, 0}}};
  REQUIRE_FALSE(std::isfinite(capsule_of(tetrahedron).radius));
}
