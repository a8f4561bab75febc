#include "apps/kit/seeds.hpp"

#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

TEST_CASE("seeds are one or a range, and a loop over them ends", "[apps]") {
  using kit::parse_seeds;
  CHECK(parse_seeds("17").last == 17);
  CHECK(parse_seeds("3:18446744073709551614").last == 18446744073709551614U);
  CHECK_THROWS_WITH(parse_seeds("3:18446744073709551615"), Contains("seeds are less than"));
  CHECK_THROWS_WITH(parse_seeds("18446744073709551615"), Contains("seeds are less than"));
  CHECK_THROWS_WITH(parse_seeds("3:2"), Contains("ends before it begins"));
  CHECK_THROWS_WITH(parse_seeds("3:x"), Contains("FROM:TO"));
}
