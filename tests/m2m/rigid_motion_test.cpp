#include "m2m/rigid_motion.hpp"

#include "tests/support/catch.hpp"

#include <array>
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

TEST_CASE("vectors and tensors turn exactly by quarter turns", "[m2m][motion]") {
  const auto turned = [](auto turn, std::vector<double> values, const RigidMotion& motion) {
    turn(values, motion);
    return values;
  };
  const double quarter = std::numbers::pi / 2;
  RigidMotion motion{.axis = {0, 0, 7}, .angle = quarter, .centre = {9, 1, 0}};
  motion.translation = {4, 4, 4};  // vectors have no place
  using Values = std::vector<double>;
  CHECK(turned(turn_vectors, {1, 2, 3, 0, 0.1, 0}, motion) == Values{-2, 1, 3, -0.1, 0, 0});
  CHECK(turned(turn_tensors, {1, 2, 3, 4, 5, 6, 7, 8, 9}, motion) ==
        Values{5, -4, -6, -2, 1, 3, -8, 7, 9});
  CHECK(turned(turn_symmetric_tensors, {1, 2, 3, 4, 5, 6}, motion) == Values{2, 1, 3, -4, 6, -5});
  for (const int n : {-7, -2, -1, 2, 3, 4, 5, 1001}) {
    Values many{1, 2, 3};
    for (int k = 0; k < (n % 4 + 4) % 4; ++k) turn_vectors(many, motion);
    CHECK(turned(turn_vectors, {1, 2, 3}, {.angle = n * quarter}) == many);
    CHECK(turned(turn_vectors, {1, 2, 3}, {.angle = n * 90.0 * std::numbers::pi / 180}) == many);
  }
  CHECK(turned(turn_vectors, {1, 2, 3}, {.angle = quarter * (1 + 1e-14)}) != Values{-2, 1, 3});
}

TEST_CASE("vectors turn as differences of points do, and there and back", "[m2m][motion]") {
  const RigidMotion motion{.axis = {1, -2, 0.3}, .angle = 1.1}, back{motion.axis, -motion.angle};
  const std::vector<double> v{0.3, -0.5, 0.7},
      square{.09, -.15, .21, -.15, .25, -.35, .21, -.35, .49},
      six{.09, .25, .49, -.15, -.35, .21};  // v vᵀ, which turns as v does
  std::vector<Point> points{{0.3, -0.5, 0.7}};
  std::vector<double> vector = v, tensor = square, symmetric = six;
  const auto turn = [&](const RigidMotion& by) {
    move_points(points, by);
    turn_vectors(vector, by);
    turn_tensors(tensor, by);
    turn_symmetric_tensors(symmetric, by);
  };
  turn(motion);
  constexpr std::array<std::size_t, 6> places{0, 4, 8, 1, 5, 2};  // xx, yy, zz, xy, yz, xz
  for (std::size_t i = 0; i < 9; ++i) {
    CHECK(std::abs(vector[i / 3] - points[0][i / 3]) < 1e-15);
    CHECK(std::abs(tensor[i] - vector[i / 3] * vector[i % 3]) < 1e-15);
    if (i < 6) CHECK(std::abs(symmetric[i] - tensor[places[i]]) < 1e-15);
  }
  turn(back);
  for (std::size_t i = 0; i < 9; ++i) {
    CHECK(std::abs(vector[i / 3] - v[i / 3]) < 1e-15);
    CHECK(std::abs(tensor[i] - square[i]) < 1e-15);
    if (i < 6) CHECK(std::abs(symmetric[i] - six[i]) < 1e-15);
  }
}

TEST_CASE("values that are no whole rows of vectors or tensors are refused", "[m2m][motion]") {
  std::vector<double> four(4);
  CHECK_THROWS_WITH(turn_vectors(four, {.angle = 1}), Contains("4 values are no vectors of 3"));
  CHECK_THROWS_WITH(turn_tensors(four, {}), Contains("4 values are no tensors of 9"));
  CHECK_THROWS_WITH(turn_symmetric_tensors(four, {}), Contains("no symmetric tensors of 6"));
}
