// The weights of moving least squares against normal equations, and their orders.
#include "m2m/rows/reconstruct/moving_least_squares.hpp"

#include "m2m/rows/search/nearest_vertex.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

using namespace tess;
using namespace tess::m2m;
using Fit = MovingLeastSquares::Fit;

namespace {

std::vector<Point> random_points(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> in_cube(0, 1);
  std::vector<Point> points(n);
  for (Point& p : points)
    for (double& x : p) x = in_cube(random);
  return points;
}

/// The neighbours of a point, nearest first.
std::vector<Point> nearest(const Point& at, std::vector<Point> points, std::size_t n) {
  std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) {
    return squared_distance(at, a) < squared_distance(at, b);
  });
  points.resize(std::min(n, points.size()));
  return points;
}

/// Monomials of offsets from the point.
std::vector<long double> monomials(const Point& d, int order) {
  std::vector<long double> out{1, d[0], d[1], d[2]};
  for (std::size_t k = 0; order == 2 && k < 3; ++k)
    for (std::size_t l = k; l < 3; ++l) out.push_back(static_cast<long double>(d[k]) * d[l]);
  return out;
}

/// By normal equations, which Gauss eliminates: W B (Bᵀ W B)⁻¹ e₀.
std::vector<double> by_normal_equations(const Point& at, const std::vector<Point>& neighbours,
                                        int order) {
  const double reach = 1.1 * std::sqrt(squared_distance(at, neighbours.back()));
  std::vector<long double> w;
  std::vector<std::vector<long double>> b;
  for (const Point& x : neighbours) {
    Point d = difference(x, at);
    for (double& v : d) v /= reach;
    const long double s = std::sqrt(dot(d, d));
    w.push_back(std::pow(1 - s, 4) * (4 * s + 1));
    b.push_back(monomials(d, order));
  }
  const std::size_t m = b[0].size();
  std::vector<std::vector<long double>> a(m, std::vector<long double>(m + 1, 0));
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = 0; j < m; ++j)
      for (std::size_t k = 0; k < w.size(); ++k) a[i][j] += w[k] * b[k][i] * b[k][j];
  a[0][m] = 1;
  for (std::size_t i = 0; i < m; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i; r < m; ++r)
      if (std::abs(a[r][i]) > std::abs(a[pivot][i])) pivot = r;
    std::swap(a[i], a[pivot]);
    for (std::size_t r = 0; r < m; ++r) {
      const long double f = r == i ? 0 : a[r][i] / a[i][i];
      for (std::size_t c = 0; c <= m; ++c) a[r][c] -= f * a[i][c];
    }
  }
  std::vector<double> weights;
  for (std::size_t k = 0; k < w.size(); ++k) {
    long double sum = 0;
    for (std::size_t i = 0; i < m; ++i) sum += b[k][i] * a[i][m] / a[i][i];
    weights.push_back(static_cast<double>(w[k] * sum));
  }
  return weights;
}

double value_of(const MovingLeastSquares& fit, const std::vector<Point>& neighbours,
                const std::function<double(const Point&)>& f) {
  double sum = 0;
  for (std::size_t j = 0; j < neighbours.size(); ++j) sum += fit.weights()[j] * f(neighbours[j]);
  return sum;
}

double quadratic_at(const Point& p) {
  return 2 - p[0] + 3 * p[1] * p[2] + p[2] * p[2] - 2 * p[0] * p[1] + 4 * p[1];
}

/// The root mean square of the errors at points within n × n × n jittered points.
double error_of(int order, int n) {
  std::vector<Point> points = random_points(static_cast<std::size_t>(n * n * n), 5);
  for (int i = 0; i < n * n * n; ++i)
    for (int k = 0, rest = i; k < 3; ++k, rest /= n) {
      double& x = points[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
      x = (rest % n + 0.2 + 0.6 * x) / n;
    }
  const NearestVertex tree(points);
  MovingLeastSquares fit(order);
  double sum = 0;
  std::vector<NearestVertex::Neighbour> found;
  std::vector<Point> neighbours;
  const std::vector<Point> targets = random_points(500, 6);
  for (const Point& at : targets) {
    tree.find(at, MovingLeastSquares::n_neighbours(order), 1e300, found);
    neighbours.clear();
    for (const auto& neighbour : found)
      neighbours.push_back(points[static_cast<std::size_t>(neighbour.vertex)]);
    (void)fit.compute(at, neighbours);
    const double error = value_of(fit, neighbours, test::smooth) - test::smooth(at);
    sum += error * error;
  }
  return std::sqrt(sum / 500);
}

}  // namespace

TEST_CASE("weights of moving least squares solve the normal equations", "[m2m][fits]") {
  for (const int order : {1, 2})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      CAPTURE(order, seed);
      const Point at = random_points(1, 100 + seed)[0];
      const std::vector<Point> neighbours =
          nearest(at, random_points(500, seed), MovingLeastSquares::n_neighbours(order));
      MovingLeastSquares fit(order);
      if (fit.compute(at, neighbours) != Fit{order, 3}) continue;  // near the surface of the cube
      const std::vector<double> want = by_normal_equations(at, neighbours, order);
      for (std::size_t j = 0; j < want.size(); ++j)
        REQUIRE(fit.weights()[j] == Approx(want[j]).margin(1e-9));
    }
}

TEST_CASE("polynomials of the order are exact, wherever and of whatever size they are",
          "[m2m][fits]") {
  int n_full = 0;
  for (const int order : {1, 2})
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      CAPTURE(order, seed);
      const double scale = seed % 2 == 0 ? 1 : 1e-6;
      std::vector<Point> points = random_points(300, seed);
      Point at = random_points(1, 1000 + seed)[0];
      for (double& x : at) x = scale * x + 3;
      for (Point& p : points)
        for (double& x : p) x = scale * x + 3;
      const auto neighbours = nearest(at, points, MovingLeastSquares::n_neighbours(order));
      const auto f = [&](const Point& p) {
        const Point d{(p[0] - at[0]) / scale, (p[1] - at[1]) / scale, (p[2] - at[2]) / scale};
        return order == 2 ? quadratic_at(d) : 2 - d[0] + 3 * d[1] - 5 * d[2];
      };
      MovingLeastSquares fit(order);
      if (fit.compute(at, neighbours).order < order) continue;
      ++n_full;
      REQUIRE(value_of(fit, neighbours, f) == Approx(2).margin(1e-10));
    }
  CHECK(n_full > 380);
}

TEST_CASE("neighbours that determine less fall back", "[m2m][fits]") {
  const auto fit_of = [](std::vector<Point> points, const Point& at,
                         const std::function<double(const Point&)>& f, double& value) {
    MovingLeastSquares fit(2);
    const std::vector<Point> neighbours = nearest(at, std::move(points), 30);
    const Fit got = fit.compute(at, neighbours);
    value = value_of(fit, neighbours, f);
    CHECK(value_of(fit, neighbours, [](const Point&) { return 1; }) == Approx(1).margin(1e-12));
    return got;
  };
  double value = 0;
  // A tilted plane x + 2 y - z = 1, and a point beside it, whose foot is meant.
  std::vector<Point> plane = random_points(60, 3);
  for (Point& p : plane) p[2] = p[0] + 2 * p[1] - 1;
  const Point foot{0.5, 0.4, 0.3}, beside{0.5 + 0.02, 0.4 + 0.04, 0.3 - 0.02};
  CHECK(fit_of(plane, foot, quadratic_at, value) == Fit{2, 2});
  CHECK(value == Approx(quadratic_at(foot)).margin(1e-10));
  CHECK(fit_of(plane, beside, quadratic_at, value) == Fit{2, 2});
  CHECK(value == Approx(quadratic_at(foot)).margin(1e-10));
  std::vector<Point> line = random_points(60, 4);
  for (Point& p : line) p = {p[0], 2 * p[0], 1 - p[0]};
  CHECK(fit_of(line, {0.5, 1, 0.5}, quadratic_at, value) == Fit{2, 1});
  CHECK(value == Approx(quadratic_at({0.5, 1, 0.5})).margin(1e-10));
  CHECK(fit_of(std::vector<Point>(40, {1, 2, 3}), {1, 2, 3.5}, quadratic_at, value) == Fit{0, 0});
  CHECK(value == Approx(quadratic_at({1, 2, 3})));
  CHECK(fit_of({{1, 2, 3}}, {1, 2, 3}, quadratic_at, value) == Fit{0, 0});
  CHECK(value == quadratic_at({1, 2, 3}));
  // Too few for a quadratic polynomial, enough for a linear one.
  CHECK(fit_of(random_points(7, 8), {0.5, 0.5, 0.5}, quadratic_at, value) == Fit{1, 3});
  // A curved wall: in the tangent plane, rather than by lower order.
  std::vector<Point> cap = random_points(4000, 9);
  for (Point& p : cap) p[2] = -0.05 * ((p[0] - 0.5) * (p[0] - 0.5) + (p[1] - 0.5) * (p[1] - 0.5));
  CHECK(fit_of(cap, {0.5, 0.5, 0.01}, test::smooth, value) == Fit{2, 2});
  CHECK(value == Approx(test::smooth({0.5, 0.5, 0})).margin(1e-4));
  // Outside weights stay small, as the order falls.
  for (const double x : {1.05, 1.1, 1.15, 1.2, 1.3, 1.5}) {
    MovingLeastSquares fit(2);
    const Point at{x, 0.5, 0.5};
    (void)fit.compute(at, nearest(at, random_points(200, 11), 30));
    double sum = 0;
    for (const double weight : fit.weights()) sum += std::abs(weight);
    CHECK(sum <= 10);
  }
  (void)fit_of(
      random_points(200, 10), {30, 0.5, 0.5}, [](const Point& p) { return p[0]; }, value);
  CHECK(value > 0);
  CHECK(value < 10);
}

TEST_CASE("moving least squares are of second and third order", "[m2m][fits]") {
  const double order_1 = std::log2(error_of(1, 8) / error_of(1, 16));
  const double order_2 = std::log2(error_of(2, 8) / error_of(2, 16));
  CAPTURE(error_of(1, 16), error_of(2, 16));
  CHECK(order_1 > 1.8);
  CHECK(order_2 > 2.7);
}
