#include "runtime/core/number.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <string_view>

using namespace tess;

TEST_CASE("a whole text is one number or none", "[runtime]") {
  CHECK(parse_number<std::int32_t>("-17") == -17);
  CHECK(parse_number<std::uint32_t>("2f61b6e8", 16) == 0x2f61b6e8U);
  CHECK(parse_number<double>("2.5e-3") == 2.5e-3);
  CHECK(std::isnan(parse_number<double>("nan").value()));
  for (const char* text : {"", " 1", "1 ", "+1", "1x", "x", "0x1"}) {
    INFO("'" << text << "'");
    CHECK(!parse_number<std::int32_t>(text));
    CHECK(!parse_number<double>(text));
  }
}

TEST_CASE("a number is taken off what follows it", "[runtime]") {
  std::string_view text = "1e3us";
  CHECK(take_number<double>(text) == 1e3);
  CHECK(text == "us");
  CHECK(!take_number<double>(text));
  CHECK(text == "us");
  text = "300,4";
  CHECK(!take_number<std::int8_t>(text));
  CHECK(text == "300,4");
}

TEST_CASE("a number beyond the range of its type is none", "[runtime]") {
  CHECK(parse_number<std::uint16_t>("65535") == 65535);
  CHECK(!parse_number<std::uint16_t>("65536"));
  CHECK(!parse_number<std::uint64_t>("-1"));
  CHECK(!parse_number<std::uint64_t>("18446744073709551616"));
  CHECK(!parse_number<double>("1e400"));
}
