#include "apps/kit/output/fit.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace kit;

TEST_CASE("the exponent of a power law is found, without zeros and infinities", "[apps][plot]") {
  std::vector<Point> samples;
  for (const double x : {0.01, 0.1, 0.5, 3.0}) samples.push_back({x, 7 * std::pow(x, -1.5)});
  CHECK(fitted_power(samples).value() == Approx(-1.5));
  samples.push_back({1, 0});
  samples.push_back({2, INFINITY});
  CHECK(fitted_power(samples).value() == Approx(-1.5));
  CHECK_FALSE(fitted_power({}));
  CHECK_FALSE(fitted_power({{1, 2}}));
  CHECK_FALSE(fitted_power({{1, 2}, {1, 3}}));
}
