#include "runtime/balance/load.hpp"

#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <limits>
#include <type_traits>

using tess::balance::Load;

static_assert(sizeof(Load) == sizeof(double));
static_assert(!std::is_convertible_v<Load, double>, "a load must be asked");

TEST_CASE("a load is at least 0 seconds, or unknown", "[balance]") {
  CHECK(Load(0).is_known());
  CHECK(Load(2.5).seconds() == 2.5);
  CHECK(Load(2.5).seconds_or(7) == 2.5);
  CHECK_FALSE(Load() == Load(0));
  CHECK(Load().seconds_or(7) == 7);
  CHECK_THROWS_WITH(Load::unknown().seconds(), Catch::Contains("takes an unknown load"));
  CHECK_THROWS_WITH(Load(-1), Catch::Contains("a load of -1 seconds; give 0 or more"));
  CHECK_THROWS_AS(Load(std::numeric_limits<double>::quiet_NaN()), tess::Error);
}
