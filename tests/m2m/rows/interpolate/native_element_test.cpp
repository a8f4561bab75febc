#include "m2m/rows/interpolate/native_element.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <random>
#include <vector>

using namespace tess::m2m;

namespace {

constexpr std::size_t native_sizes[] = {5, 6, 8, 10, 27};

/// The element in reference coordinates.
std::vector<Point> reference_element(std::size_t n) {
  std::vector<Point> vertices;
  for (std::size_t k = 0; k < n; ++k) vertices.push_back(reference_vertex(n, k));
  return vertices;
}
/// Sheared, and each vertex moved by up to `amount`.
std::vector<Point> distorted(std::size_t n, double amount, std::mt19937_64& random) {
  std::uniform_real_distribution<double> by(-amount, amount);
  std::vector<Point> vertices = reference_element(n);
  for (Point& p : vertices)
    p = {3 + 2 * p[0] + 0.4 * p[1] + by(random), 0.3 * p[2] + p[1] + by(random),
         p[2] - 0.2 * p[0] + by(random)};
  return vertices;
}
Point point_in(std::span<const Point> vertices, const Point& r) {
  const ShapeFunctions shape = shape_functions(vertices.size(), r);
  Point p{};
  for (std::size_t k = 0; k < vertices.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += shape.values[k] * vertices[k][axis];
  return p;
}
/// A point of the reference element.
Point random_place(std::size_t n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> in(0, 1);
  Point r{};
  do r = {in(random), in(random), in(random)};
  while (!(depth_in_element(n, r) >= 0));
  return r;
}
/// The orientation of the map, from central differences.
double orientation(std::span<const Point> vertices, const Point& r) {
  std::array<Point, 3> by{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Point up = r, down = r;
    up[axis] += 1e-5, down[axis] -= 1e-5;
    by[axis] = difference(point_in(vertices, up), point_in(vertices, down));
  }
  return dot(by[0], cross(by[1], by[2]));
}
Point centre_of(std::size_t n) {
  Point centre{};
  for (const Point& r : reference_element(n))
    for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] += r[axis] / static_cast<double>(n);
  return centre;
}

}  // namespace

TEST_CASE("shape functions sum to 1, are 1 at their vertex, and reproduce r", "[m2m][native]") {
  std::mt19937_64 random(1);
  for (const std::size_t n : native_sizes) {
    CAPTURE(n);
    const std::vector<Point> reference = reference_element(n);
    for (std::size_t k = 0; k < n; ++k) {
      if (n == 5 && k == 4) continue;  // the apex has no row of its own
      const ShapeFunctions at = shape_functions(n, reference[k]);
      for (std::size_t j = 0; j < n; ++j) CHECK(at.values[j] == (j == k ? 1 : 0));
    }
    for (int i = 0; i < 50; ++i) {
      const Point r = random_place(n, random);
      const ShapeFunctions shape = shape_functions(n, r);
      double sum = 0;
      Point slope{};
      for (std::size_t k = 0; k < n; ++k) {
        sum += shape.values[k];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          slope[axis] += shape.gradients[k][axis];
          Point up = r, down = r;
          up[axis] += 1e-6, down[axis] -= 1e-6;
          const double by =
              (shape_functions(n, up).values[k] - shape_functions(n, down).values[k]) / 2e-6;
          CHECK(std::abs(by - shape.gradients[k][axis]) < 1e-4);
        }
      }
      CHECK(std::abs(sum - 1) < 1e-14);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(std::abs(slope[axis]) < 1e-12);
        CHECK(std::abs(point_in(reference, r)[axis] - r[axis]) < 1e-14);
      }
    }
  }
}

TEST_CASE("the map of distorted elements is inverted", "[m2m][native]") {
  std::mt19937_64 random(1);
  for (const std::size_t n : native_sizes)
    for (const double scale : {1e-80, 1.0, 1e80})
      for (int i = 0; i < 200; ++i) {
        CAPTURE(n, scale, i);
        std::vector<Point> vertices = distorted(n, n >= 10 ? 0.03 : 0.12, random);
        for (Point& p : vertices)
          for (double& x : p) x *= scale;
        const Point want = random_place(n, random);
        const auto found = invert_element(point_in(vertices, want), vertices, centre_of(n));
        REQUIRE(found);
        for (std::size_t axis = 0; axis < 3; ++axis)
          CHECK(std::abs((*found)[axis] - want[axis]) < 1e-11);
      }
}

TEST_CASE("points near the apex of a distorted pyramid are found", "[m2m][native]") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Point> vertices = distorted(5, 0.1, random);
    const Point in = random_place(5, random);
    for (const double s : {1e-2, 1e-5, 1e-8, 1e-11}) {
      CAPTURE(i, s);
      const Point want{in[0] * s, in[1] * s, 1 - s * (1 - in[2])};
      // As the split starts it: in the plane through three corners of the base and the apex.
      const Point start{want[0] + 0.1 * s, want[1], want[2]};
      const Point p = point_in(vertices, want);
      const auto found = invert_element(p, vertices, start);
      REQUIRE(found);
      const Point back = point_in(vertices, *found);
      for (std::size_t axis = 0; axis < 3; ++axis)
        CHECK(std::abs(back[axis] - p[axis]) < 1e-14 * 8);
    }
  }
}

TEST_CASE("where an element folds over, no inverse is taken from behind the fold",
          "[m2m][native]") {
  std::mt19937_64 random(1);
  for (const std::size_t n : native_sizes) {
    int n_found = 0, n_refused = 0;
    for (int i = 0; i < 1000; ++i) {
      const std::vector<Point> vertices = distorted(n, n >= 10 ? 0.5 : 1, random);
      const Point at = random_place(n, random), centre = centre_of(n);
      const auto found = invert_element(point_in(vertices, at), vertices, centre);
      ++(found ? n_found : n_refused);
      if (found) CHECK(orientation(vertices, *found) * orientation(vertices, centre) > 0);
    }
    CAPTURE(n, n_found, n_refused);
    CHECK(n_found > 300);
    CHECK(n_refused > 20);
  }
}

TEST_CASE("a point is found up to the slack outside", "[m2m][native]") {
  for (const std::size_t n : native_sizes) {
    std::vector<Point> vertices;
    for (std::size_t k = 0; k < n; ++k) vertices.push_back(reference_vertex(n, k));
    CHECK(invert_element({0.1, 0.2, -0.05}, vertices, centre_of(n)));
    CHECK_FALSE(invert_element({0.1, 0.2, -0.05}, vertices, centre_of(n), 1e-9));
    CHECK_FALSE(invert_element({0.1, 0.2, -0.5}, vertices, centre_of(n)));
  }
}

TEST_CASE("elements without volume have no inverse", "[m2m][native]") {
  for (const std::size_t n : native_sizes) {
    std::vector<Point> vertices(n);
    CHECK_FALSE(invert_element({0, 0, 0}, vertices, centre_of(n)));
    vertices[0] = {NAN, 0, 0};
    CHECK_FALSE(invert_element({0, 0, 0}, vertices, centre_of(n)));
  }
}
