#include "apps/median.hpp"

#include "tests/support/catch.hpp"

TEST_CASE("the median of an even number of values is the mean of the two in the middle", "[apps]") {
  CHECK(apps::median({7}) == 7);
  CHECK(apps::median({1, 3}) == 2);
  CHECK(apps::median({9, 1, 4}) == 4);
  CHECK(apps::median({100, 2, -5, 4}) == 3);
}
