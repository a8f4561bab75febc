// The nearest point of a tetrahedron, by the condition that decides it: a point of a convex body is
// nearest to p if no corner lies beyond the plane through it that is normal to the way to p.
#include "m2m/rows/interpolate/nearest_point.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <random>

using namespace tess::m2m;

namespace {

using Corners = std::array<Point, 4>;

Corners random_corners(std::mt19937_64& random, const Point& sides) {
  std::uniform_real_distribution<double> part(0, 1);
  Corners corners;
  for (Point& c : corners)
    for (std::size_t axis = 0; axis < 3; ++axis) c[axis] = sides[axis] * part(random);
  return corners;
}

/// Checks weights, distance and the condition; lengths are of the order 1, times `scale`.
void check_nearest(const Point& p, const Corners& corners, double scale) {
  const NearestPoint near = nearest_point(p, corners);
  double sum = 0;
  Point q{};
  for (std::size_t i = 0; i < 4; ++i) {
    REQUIRE(near.weights[i] >= 0);
    sum += near.weights[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      q[axis] += near.weights[i] * (corners[i][axis] / scale);
  }
  REQUIRE(std::abs(sum - 1) < 1e-15);
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    squared += (p[axis] / scale - q[axis]) * (p[axis] / scale - q[axis]);
  REQUIRE(std::abs(std::sqrt(squared) - near.distance / scale) < 1e-13);
  for (const Point& c : corners) {
    double beyond = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      beyond += (p[axis] / scale - q[axis]) * (c[axis] / scale - q[axis]);
    REQUIRE(beyond < 1e-9);  // slivers: the foot on an edge is as good as one on a face beside it
  }
}

}  // namespace

TEST_CASE("no corner of a tetrahedron lies beyond its point nearest to a point outside",
          "[m2m][locate]") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-1, 2);
  int n_corner = 0, n_edge = 0, n_face = 0;
  // Well shaped, slivers, flat ones, and a segment; then all at scales whose squares overflow.
  for (const double scale : {1.0, 1e-80, 1e95})
    for (const Point& sides : {Point{1, 1, 1}, Point{1, 1, 1e-7}, Point{1, 1, 0}, Point{1, 0, 0}})
      for (int i = 0; i < 400; ++i) {
        Corners corners = random_corners(random, sides);
        Point p{place(random), place(random), place(random)};
        for (Point& c : corners)
          for (double& x : c) x *= scale;
        for (double& x : p) x *= scale;
        if (locate(p, corners)) continue;
        INFO("scale " << scale << ", sides " << sides[0] << ' ' << sides[1] << ' ' << sides[2]);
        check_nearest(p, corners, scale);
        int n_used = 0;
        for (const double w : nearest_point(p, corners).weights) n_used += w > 0 ? 1 : 0;
        n_corner += n_used == 1 ? 1 : 0;
        n_edge += n_used == 2 ? 1 : 0;
        n_face += n_used == 3 ? 1 : 0;
      }
  CHECK(n_corner > 300);
  CHECK(n_edge > 300);
  CHECK(n_face > 50);
}

TEST_CASE("the distance from a face, an edge and a corner is that of geometry", "[m2m][locate]") {
  const Corners corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  CHECK(nearest_point({0.25, 0.25, -0.5}, corners).distance == 0.5);
  CHECK(nearest_point({0.5, -3, -4}, corners).distance == 5);
  CHECK(nearest_point({0, 0, 3}, corners).distance == 2);
  CHECK(nearest_point({0, 0, 3}, corners).weights == Weights{0, 0, 0, 1});
  CHECK(nearest_point({1, 1, 1}, corners).distance == Approx(2 / std::sqrt(3)).epsilon(1e-15));
  // Far from the origin only the rounding of the coordinates is lost.
  Corners far = corners;
  for (Point& c : far) c[0] += 1e9;
  CHECK(nearest_point({1e9 + 0.25, 0.25, -0x1p-20}, far).distance == 0x1p-20);
}

TEST_CASE("a point that snaps within rounding has its distance", "[m2m][locate]") {
  const Corners corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const auto snapped = locate({0.25, 0.25, -1e-11}, corners);
  REQUIRE(snapped);
  CHECK(snapped->status == Status::snapped);
  CHECK(snapped->distance == Approx(1e-11));
  CHECK(locate({0.25, 0.25, 0.25}, corners)->distance == 0);
}
