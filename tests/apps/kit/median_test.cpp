#include "apps/kit/median.hpp"

#include "tests/support/catch.hpp"

TEST_CASE("the median of an even number of values is the mean of the two in the middle", "[apps]") {
  CHECK(kit::median({7}) == 7);
  CHECK(kit::median({1, 3}) == 2);
  CHECK(kit::median({9, 1, 4}) == 4);
  CHECK(kit::median({100, 2, -5, 4}) == 3);
}
