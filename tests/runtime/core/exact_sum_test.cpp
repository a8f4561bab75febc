#include "runtime/core/exact_sum.hpp"

#include "runtime/core/hash.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <vector>

using tess::ExactSum;

TEST_CASE("an exact sum does not depend on its order or its parts", "[runtime][core]") {
  tess::Random random(7);
  std::vector<double> values;
  for (int i = 0; i < 3000; ++i)
    values.push_back(std::ldexp(random.unit() - 0.5, static_cast<int>(random.below(400)) - 200));
  const auto sum_of = [&](std::size_t cut) {
    ExactSum a, b;
    for (std::size_t i = 0; i < values.size(); ++i) (i < cut ? a : b).add(values[i]);
    a.add(b);
    return a.total();
  };
  const double once = sum_of(values.size());
  for (const std::size_t cut : {0U, 1U, 1500U}) {
    std::reverse(values.begin() + 10, values.end());
    CHECK(sum_of(cut) == once);
  }
}

TEST_CASE("an exact sum with a value that is not finite is not finite", "[runtime][core]") {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  ExactSum up, down;
  up.add(1.5);
  CHECK(up.total() == 1.5);
  up.add(infinite);
  CHECK(up.total() == infinite);
  up.add(infinite);
  CHECK(up.total() == infinite);
  down.add(-infinite);
  CHECK(down.total() == -infinite);
  up.add(down);
  CHECK(std::isnan(up.total()));
  ExactSum none;
  none.add(std::numeric_limits<double>::quiet_NaN());
  none.add(3);
  CHECK(std::isnan(none.total()));
}

TEST_CASE("values of an exact sum cancel without rounding", "[runtime][core]") {
  ExactSum sum;
  for (const double value : {1e300, 3.0, -1e300, 1e-300, -0.5}) sum.add(value);
  CHECK(sum.total() == 2.5);
  for (const double value : {-3.0, 0.5, -1e-300}) sum.add(value);
  CHECK(sum.total() == 0);
  sum.add(-std::numeric_limits<double>::denorm_min());
  CHECK(sum.total() == -std::numeric_limits<double>::denorm_min());
  sum.add(std::numeric_limits<double>::max());
  sum.add(std::numeric_limits<double>::denorm_min());
  CHECK(sum.total() == std::numeric_limits<double>::max());
}
