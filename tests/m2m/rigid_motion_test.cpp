#include "m2m/rigid_motion.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace tess::m2m;

TEST_CASE("a rotation turns counter-clockwise around its axis", "[m2m][motion]") {
  std::vector<Point> points{{2, 1, 5}, {1, 1, -3}};
  move_points(points, {.axis = {0, 0, 7}, .angle = std::numbers::pi / 2, .centre = {1, 1, 0}});
  CHECK(points[0][0] == Approx(1));
  CHECK(points[0][1] == Approx(2));
  CHECK(points[0][2] == 5);
  CHECK(points[1] == Point{1, 1, -3});  // on the axis
}

TEST_CASE("a rotation keeps distances, and a translation without one is exact", "[m2m][motion]") {
  std::vector<Point> points{{1e9, 1, 5}, {1, -4, -3}};
  move_points(points, {.translation = {0.5, 0, -1}});
  CHECK(points == std::vector<Point>{{1e9 + 0.5, 1, 4}, {1.5, -4, -4}});
  points = {{1, 2, 5}, {1, -4, -3}};
  move_points(points, {.axis = {1, -2, 0.3}, .angle = 1.1, .centre = {0, 9, 0}});
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    squared += (points[0][axis] - points[1][axis]) * (points[0][axis] - points[1][axis]);
  CHECK(squared == Approx(100));
}

TEST_CASE("a rotation about an axis without a length is refused, and moves no point",
          "[m2m][motion]") {
  std::vector<Point> points{{1, 2, 5}};
  CHECK_THROWS_WITH(move_points(points, {.axis = {0, 0, 0}, .angle = 1}),
                    Contains("about the axis (0, 0, 0) has no direction"));
  CHECK_THROWS(move_points(points, {.axis = {0, std::nan(""), 0}, .angle = 1}));
  CHECK(points[0] == Point{1, 2, 5});
}
