// Radial basis interpolation: what it finds again, and what is refused.
#include "m2m/radial_basis.hpp"

#include "apps/kit/worst.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <random>

using namespace tess::m2m;

namespace {

constexpr RadialBasisOptions wendland{RadialKernel::wendland, 0.7};

std::vector<Point> random_points(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> in_cube(0, 1);
  std::vector<Point> points(n);
  for (Point& p : points) p = {in_cube(random), in_cube(random), in_cube(random)};
  return points;
}

double linear(const Point& p) {
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2];
}

/// Values of two components.
std::vector<double> sampled(const std::vector<Point>& points) {
  std::vector<double> values;
  for (const Point& p : points) values.insert(values.end(), {tess::test::smooth(p), linear(p)});
  return values;
}

}  // namespace

TEST_CASE("radial basis interpolation finds the field that its kernel makes",
          "[m2m][radial_basis]") {
  // Triples on lines with the coefficients 1, -2, 1 times a number are orthogonal to linear fields.
  std::vector<Point> points = random_points(60, 1);
  std::vector<double> c;
  for (std::size_t i = 0; i < 60; i += 3) {
    for (std::size_t k = 0; k < 3; ++k) points[i + 2][k] = 2 * points[i + 1][k] - points[i][k];
    const double factor = points[i + 1][0] - 0.5;
    c.insert(c.end(), {factor, -2 * factor, factor});
  }
  const auto compare = [&](const RadialBasisOptions& options, double (*kernel)(double)) {
    const auto field = [&](const std::vector<Point>& at) {
      std::vector<double> values;
      for (const Point& x : at) {
        values.insert(values.end(), {linear(x), linear(x)});
        for (std::size_t j = 0; j < 60; ++j) {
          const Point d = difference(x, points[j]);
          values.back() += c[j] * kernel(std::sqrt(dot(d, d)));
        }
      }
      return values;
    };
    const std::vector<Point> targets = random_points(40, 2);
    const std::vector<double> got = RadialBasis(points, options).values(field(points), 2, targets),
                              want = field(targets);
    for (std::size_t i = 0; i < got.size(); ++i) CHECK(std::abs(got[i] - want[i]) < 1e-11);
  };
  compare({}, [](double r) { return r == 0 ? 0 : r * r * std::log(r); });
  compare(wendland,
          [](double r) { return r < 0.7 ? std::pow(1 - r / 0.7, 4) * (4 * r / 0.7 + 1) : 0; });
}

TEST_CASE(
    "radial basis interpolation has the values of its points, wherever they are and how large",
    "[m2m][radial_basis]") {
  const std::vector<Point> points = random_points(200, 3), targets = random_points(50, 4);
  const std::vector<double> given = sampled(points),
                            want = RadialBasis(points).values(given, 2, targets);
  for (const double size : {1e-6, 1.0, 1e6}) {
    const auto place = [&](std::vector<Point> all) {
      for (Point& p : all)
        for (double& x : p) x = size * (x + 10);
      return all;
    };
    RadialBasis basis(random_points(4, 5));
    basis = RadialBasis(place(points));
    double error = 0;
    const std::vector<double> there = basis.values(given, 2, place(targets)),
                              at_points = basis.values(given, 2, place(points));
    for (std::size_t i = 0; i < there.size(); ++i) kit::worsen(error, std::abs(there[i] - want[i]));
    for (std::size_t i = 0; i < given.size(); ++i)
      kit::worsen(error, std::abs(at_points[i] - given[i]));
    CAPTURE(size, error);
    CHECK(error < 1e-10);
  }
}

TEST_CASE("points that determine no radial basis interpolant are refused in one line",
          "[m2m][radial_basis]") {
  const auto refused = [](auto change, const RadialBasisOptions& options,
                          const std::string& words) {
    std::vector<Point> points = random_points(30, 6);
    change(points);
    CHECK_THROWS_WITH(RadialBasis(points, options), Contains("radial basis: ") && Contains(words));
  };
  for (const RadialBasisOptions& options : {RadialBasisOptions{}, wendland}) {
    refused(
        [](auto& p) { p[20] = p[7]; }, options,
        "points 7 and 20, the nearest two, have the distance 0, so that the system is singular or "
        "ill-conditioned; merge such points");
    refused([](auto& p) { p[20] = p[7], p[20][0] += 1e-7; }, options, "points 7 and 20");
    refused(
        [](auto& points) {
          for (Point& p : points) p[2] = 1 + p[0] + 2 * p[1];
        },
        options, "the 30 points lie in a plane");
    refused(
        [](auto& points) {
          for (Point& p : points) p = {p[0], -p[0], 3};
        },
        options, "the 30 points lie on a line");
    refused([](auto& p) { p.resize(3); }, options, "3 points determine no linear polynomial");
    refused([](auto& p) { p[9][1] = NAN; }, options, "point 9 has the coordinate nan");
    refused([](auto& p) { p.resize(20'001); }, options, "20001 points need a matrix of 3.2");
  }
  refused([](auto&) {}, {RadialKernel::wendland, 0},
          "the radius 0 of kernel wendland is not positive");
  refused([](auto&) {}, {RadialKernel::wendland, 1e5}, "or choose a smaller radius");
  CHECK(RadialBasis(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
            .values(std::vector<double>{1, 3, -2, 6}, 1, std::vector<Point>{{2, 2, 2}})[0] ==
        Approx(9));
}
