// The foot of a point on a cell. The oracle decides in whole numbers, of which small ones meet
// every special case: points on edges and corners, above them, and triangles without area.
#include "m2m/rows/interpolate/foot.hpp"

#include "collide/distance.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

using namespace tess::m2m;

namespace {

using Corners = std::array<Point, 4>;

/// The squared distance as a fraction, and how many corners the feature has. A candidate is the foot
/// on the face, the feet on edges, and the corners. Whole numbers up to 5 lose no digit here.
struct Exact {
  double over = -1, under = 1;
  int n_corners = 0;
  void offer(double a, double b, int n) {
    if (over < 0 || a * under < over * b) *this = {a, b, n};
  }
};
Exact exact_foot(const Point& p, const Corners& c) {
  Exact best;
  const Point normal = cross(difference(c[1], c[0]), difference(c[2], c[0]));
  bool is_over = true;
  for (std::size_t i = 0; i < 3; ++i)
    best.offer(dot(difference(p, c[i]), difference(p, c[i])), 1, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point along = difference(c[(i + 1) % 3], c[i]), way = difference(p, c[i]);
    const Point off = cross(along, way);
    const double part = dot(along, way), whole = dot(along, along);
    if (part > 0 && part < whole) best.offer(dot(off, off), whole, 2);
    is_over = is_over && dot(normal, off) > 0;
  }
  const double height = dot(normal, difference(p, c[0]));
  if (is_over) best.offer(height * height, dot(normal, normal), 3);
  return best;
}

/// A search must not pass over a triangle at this distance.
void check_not_beyond(const Point& p, const Corners& corners, double distance) {
  if (is_beyond(p, corners, distance * distance)) FAIL("beyond its distance " << distance);
}

/// The weights are those of a point at this distance.
void check_location(const Point& p, const Corners& corners, std::int32_t dimension, double scale) {
  const Foot foot = foot_of(p, corners, dimension);
  const Location at = location_of(foot, p, corners, dimension);
  if (dimension == 2) check_not_beyond(p, corners, foot.distance);
  double sum = 0;
  Point q{};
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_used = (foot.feature >> i & 1U) != 0;
    if (is_used != (at.weights[i] > 0) || at.weights[i] < 0)
      FAIL("weight " << at.weights[i] << " of corner " << i);
    sum += at.weights[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      q[axis] += at.weights[i] * ((corners[i][axis] - p[axis]) / scale);
  }
  if (!(std::abs(sum - 1) < 1e-12)) FAIL("sum of weights " << sum);
  const double length = std::hypot(q[0], q[1], q[2]);
  if (!(std::abs(length - foot.distance / scale) < 1e-12 * std::max(1.0, length)))
    FAIL("distance " << foot.distance / scale << " of a point " << length << " away");
}

}  // namespace

TEST_CASE("the feature and the distance of a foot are those of whole numbers", "[m2m][foot]") {
  std::mt19937_64 random(5);
  std::array<int, 4> n_of{};
  for (const int most : {1, 2, 5})
    for (int k = 0; k < 8000; ++k) {
      std::uniform_int_distribution<int> coordinate(-most, most);
      const auto point = [&] {
        return Point{1.0 * coordinate(random), 1.0 * coordinate(random), 1.0 * coordinate(random)};
      };
      Corners c{point(), point(), point()};
      c[3] = c[2];
      const Point p = point();
      const Exact want = exact_foot(p, c);
      const Foot foot = foot_of(p, c, 2);
      const double distance = std::sqrt(want.over / want.under);
      INFO("corners up to " << most << ", case " << k);
      if ((foot.distance == 0) != (want.over == 0)) FAIL("on the triangle or not");
      if (!(std::abs(foot.distance - distance) <= 1e-14 * distance)) FAIL(foot.distance);
      const int n_corners = std::popcount(foot.feature);
      const Point normal = cross(difference(c[1], c[0]), difference(c[2], c[0]));
      // Of a triangle without area several edges may hold the foot, and its corner be between them.
      if (dot(normal, normal) > 0 ? n_corners != want.n_corners : n_corners == 3)
        FAIL(n_corners << " corners instead of " << want.n_corners);
      const double height = dot(normal, difference(p, c[0]));
      if (side_of(p, c) != (height > 0) - (height < 0)) FAIL("side");
      ++n_of[static_cast<std::size_t>(n_corners)];
      check_location(p, c, 2, most);
    }
  CHECK(*std::min_element(n_of.begin() + 1, n_of.end()) > 1000);
}

TEST_CASE("feet on slivers, at any scale and far from the origin, are those of exact numbers",
          "[m2m][foot]") {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> part(0, 1), place(-1, 2);
  for (const double scale : {1.0, 1e-80, 1e95})
    for (const double offset : {0.0, 1e6})
      for (const Point& sides : {Point{1, 1, 1}, Point{1, 1, 1e-7}, Point{1, 1e-9, 1e-9}})
        for (int k = 0; k < 500; ++k) {
          Corners corners{};
          for (std::size_t axis = 0; axis < 3; ++axis)
            for (Point& c : corners) c[axis] = scale * (offset + sides[axis] * part(random));
          corners[3] = corners[2];
          Point p;
          for (double& x : p) x = scale * (offset + place(random));
          if (k % 3 < 2)  // in the face, or on an edge, but for rounding
            for (std::size_t axis = 0; axis < 3; ++axis)
              p[axis] = 0.3 * corners[0][axis] + (k % 3 == 0 ? 0.3 : 0.7) * corners[1][axis] +
                        (k % 3 == 0 ? 0.4 : 0.0) * corners[2][axis];
          INFO("scale " << scale << ", offset " << offset << ", " << sides[1] << ", case " << k);
          const tess::collide::Triangle triangle{{corners[0], corners[1], corners[2]}};
          const Foot foot = foot_of(p, corners, 2);
          check_not_beyond(p, corners, foot.distance);
          const auto weights = tess::collide::nearest_weights(triangle, p);
          for (std::size_t i = 0; i < 3; ++i)
            if ((weights[i] > 0) != ((foot.feature >> i & 1U) != 0)) FAIL("feature");
          if (scale == 1) {
            const double want = std::sqrt(tess::collide::distance2(triangle, p));
            if (!(std::abs(foot.distance - want) <= 1e-15 + 1e-12 * want))
              FAIL(foot.distance - want);
          }
          const Location at = location_of(foot, p, corners, 2);
          for (std::size_t i = 0; i < 3; ++i)
            if (!(std::abs(at.weights[i] - weights[i]) < 1e-12)) FAIL(at.weights[i] - weights[i]);
        }
}

TEST_CASE("the triangles at an edge give it the same distance in any order", "[m2m][foot]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  const auto point = [&] { return Point{part(random), part(random), part(random)}; };
  int n_edge = 0, n_beyond = 0;
  for (int k = 0; k < 4000; ++k) {
    const Point a = point(), b = point(), c = point(), d = point(), p = point();
    const Foot one = foot_of(p, {a, b, c, c}, 2), other = foot_of(p, {d, b, a, a}, 2);
    n_beyond += is_beyond(p, {a, b, c, c}, 0.25 * one.distance * one.distance) ? 1 : 0;
    if (one.feature != 0b011 || other.feature != 0b110) continue;
    ++n_edge;
    if (one.distance != other.distance) FAIL("case " << k);
    if (one.distance != foot_of(p, {b, a, a, a}, 1).distance) FAIL("case " << k << ", edge");
  }
  CHECK(n_edge > 100);
  CHECK(n_beyond > 1000);
}

TEST_CASE(
    "a point outside a tetrahedron has its foot on a face, and a cell of any dimension locates",
    "[m2m][foot]") {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> part(0, 1), place(-1, 2);
  for (int k = 0; k < 2000; ++k) {
    Corners corners;
    for (Point& c : corners) c = {part(random), part(random), part(random)};
    const Point p{place(random), place(random), place(random)};
    if (!locate(p, corners)) {
      const tess::collide::Tetrahedron tet{{corners[0], corners[1], corners[2], corners[3]}};
      const double want = std::sqrt(tess::collide::distance2(tet, p));
      if (!(std::abs(foot_of(p, corners, 3).distance - want) < 1e-12 * want)) FAIL("case " << k);
      check_location(p, corners, 3, 1);
    }
    check_location(p, {corners[0], corners[1], corners[2], corners[2]}, 2, 1);
    check_location(p, {corners[0], corners[1], corners[1], corners[1]}, 1, 1);
    const Location at = location_of(foot_of(corners[1], corners, 2), corners[1], corners, 2);
    CHECK(at.place == Place::corner);
    CHECK(at.weights == Weights{0, 1, 0, 0});
    CHECK(at.status == Status::boundary);
  }
}
