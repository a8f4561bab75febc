#include "collide/distance.hpp"

#include "tests/collide/shapes/rational.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <random>
#include <vector>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

/// The nearest point of a triangle by definition: of those corners, feet on edges and foot on the
/// face that are within it.
Exact exact_nearest(const Triangle& t, const Point& point) {
  const Exact p = exact(point);
  std::vector<Exact> all;
  std::array<Exact, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = exact(t.corners[i]);
  const Exact normal = cross(c[1] - c[0], c[2] - c[0]);
  bool is_above = dot(normal, normal) != 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Exact edge = c[(i + 1) % 3] - c[i];
    all.push_back(c[i]);
    if (dot(edge, edge) == 0) continue;
    const Rational along = dot(p - c[i], edge) / dot(edge, edge);
    if (along > 0 && along < 1) all.push_back(c[i] + along * edge);
    is_above = is_above && dot(cross(edge, p - c[i]), normal) >= 0;
  }
  if (is_above) all.push_back(p - (dot(normal, p - c[0]) / dot(normal, normal)) * normal);
  Exact best = all[0];
  for (const Exact& q : all)
    if (distance2(q, p) < distance2(best, p)) best = q;
  return best;
}

bool is_relative_error_below(double x, const Rational& expected, double bound) {
  return abs(Rational(x) - expected) <= expected * Rational(bound);
}

}  // namespace

TEST_CASE("distances to triangles and segments have a relative error below 2^-43, needles included",
          "[collide][shapes]") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int i = 0; i < 800; ++i) {
    const double offset = i % 4 == 1 ? 1e12 : 0, thin = i % 4 == 2 ? 1e-14 : 1;
    const double near = i % 3 == 0 ? 1e-13 : 1;
    const auto point = [&] {
      return Point{offset + some(random), offset + some(random) * thin, some(random) * thin};
    };
    Triangle t{{point(), point(), point()}};
    if (i % 16 == 3) t.corners[2] = t.corners[0];
    Point p{};  // in the plane of the triangle up to rounding, or anywhere
    const double u = some(random), v = some(random);
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = t.corners[0][k] + u * (t.corners[1][k] - t.corners[0][k]) +
             v * (t.corners[2][k] - t.corners[0][k]) + near * some(random);
    INFO(i);
    const Exact nearest = exact_nearest(t, p);
    REQUIRE(is_relative_error_below(distance2(t, p), distance2(nearest, exact(p)), 0x1p-43));
    const Point way = offset_to(t, p), found = nearest_point(t, p);
    for (std::size_t k = 0; k < 3; ++k) {
      const Rational expected = nearest[k] - Rational(p[k]);
      REQUIRE(abs(Rational(way[k]) - expected) <= abs(expected) * Rational(0x1p-43));
      REQUIRE(found[k] == p[k] + way[k]);
    }
    const Segment s{t.corners[0], t.corners[1]};
    const Exact on_segment = exact_nearest({{s.from, s.to, s.to}}, p);
    REQUIRE(is_relative_error_below(distance2(s, p), distance2(on_segment, exact(p)), 0x1p-43));
  }
}

TEST_CASE("the way to the nearest edge is found where squares of lengths are zero or infinite",
          "[collide][shapes]") {
  for (const double unit : {0x1p-600, 1.0, 0x1p600}) {
    const auto at = [&](double x, double y) { return Point{x * unit, y * unit, 0}; };
    const Triangle t{{at(0, 0), at(8, 0), at(8, 8)}};
    CHECK(offset_to(t, at(9, 5)) == at(-1, 0));
    CHECK(offset_to(t, at(1, 3)) == at(1, -1));
    CHECK(offset_to(t, at(-3, -1)) == at(3, 1));
  }
}

TEST_CASE("distances to boxes, balls, points and tetrahedra", "[collide][shapes]") {
  const Point p{4, 6, 3};
  CHECK(distance2(Point{1, 2, 3}, p) == 25);
  CHECK(distance2(Aabb{{0, 0, 0}, {1, 2, 9}}, p) == 25);
  CHECK(distance2(Aabb{{0, 0, 0}, {9, 9, 9}}, p) == 0);
  CHECK(distance2(Sphere{{1, 2, 3}, 2}, p) == 9);
  CHECK(distance2(Sphere{{1, 2, 3}, 5}, p) == 0);
  CHECK(distance2(Sphere{{1, 2, 3}, 6}, p) == 0);
  const Tetrahedron t{{Point{0, 0, 0}, Point{8, 0, 0}, Point{0, 8, 0}, Point{0, 0, 8}}};
  CHECK(distance2(t, Point{1, 1, 1}) == 0);
  CHECK(distance2(t, Point{2, 2, -3}) == 9);
  CHECK(distance2(t, Point{8, 8, 8}) == Approx(256.0 / 3));
  CHECK(distance2(t, Point{-3, -4, 1}) == 25);
}
