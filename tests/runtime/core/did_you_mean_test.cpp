#include "runtime/core/did_you_mean.hpp"

#include "tests/support/catch.hpp"

TEST_CASE("the nearest name is the one with the fewest letters changed, if they are few",
          "[runtime][core]") {
  const char* const kinds = "linear, second-order, limited, nearest, value:NUMBER, rcb";
  CHECK(tess::nearest_name("linaer", kinds) == "linear");
  CHECK(tess::nearest_name("neerest", kinds) == "nearest");
  CHECK(tess::nearest_name("second_order", kinds) == "second-order");
  CHECK(tess::nearest_name("rbc", kinds) == "rcb");
  CHECK(tess::nearest_name("value", kinds) == "value");
  CHECK(tess::nearest_name("perhaps", kinds).empty());
  CHECK(tess::nearest_name("", kinds).empty());
  CHECK(tess::nearest_name("nearest 4", kinds).empty());
  CHECK(tess::nearest_name("linear", "").empty());
  CHECK(tess::nearest_name("--pse", "-h,--help --pes --sim") == "--pes");
  CHECK(tess::nearest_name("-x", "-h,--help -y").empty());
}

TEST_CASE("a refusal ends in a question, or in nothing", "[runtime][core]") {
  CHECK(tess::did_you_mean("greedi", "greedy, refine") == "; did you mean greedy?");
  CHECK(tess::did_you_mean("anything", "greedy, refine").empty());
}
