#include "runtime/base/interval_set.hpp"

#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <set>

namespace {

TEST_CASE("an interval set holds what was inserted, in whatever order", "[runtime][base]") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    tess::Random random(seed);
    tess::detail::IntervalSet intervals;
    std::set<std::uint64_t> oracle;
    const std::uint64_t range = 1 + random.below(60);
    for (std::uint64_t n = random.below(2 * range); n > 0; --n) {
      const std::uint64_t number = random.below(range);
      intervals.insert(number);
      oracle.insert(number);
    }
    std::size_t n_runs = 0;
    for (std::uint64_t number = 0; number < range + 2; ++number) {
      INFO("seed " << seed << ", number " << number);
      REQUIRE(intervals.contains(number) == oracle.contains(number));
      if (oracle.contains(number) && !oracle.contains(number + 1)) ++n_runs;
    }
    CHECK(intervals.n_intervals() == n_runs);
  }
}

TEST_CASE("numbers in a row are one interval", "[runtime][base]") {
  tess::detail::IntervalSet intervals;
  for (std::uint64_t number = 1'000'000; number > 0; --number) intervals.insert(number);
  CHECK(intervals.n_intervals() == 1);
  CHECK(intervals.contains(1));
  CHECK_FALSE(intervals.contains(0));
  CHECK_FALSE(intervals.contains(1'000'001));
}

}  // namespace
