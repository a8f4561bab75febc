// What peak_bytes() measures.
#include "apps/bench/collide/peak_memory.hpp"

#include "tests/support/catch.hpp"

#include <vector>

TEST_CASE("the peak of memory is counted, also if it is freed before the end",
          "[apps][bench][collide]") {
  constexpr std::size_t big = std::size_t{64} << 20, slack = std::size_t{4} << 20;
  std::vector<char> before(big, 1);  // not counted
  const std::size_t peak = bench::peak_bytes([&] {
    { std::vector<char> first(big, 1); }
    std::vector<char> second(big / 2, before.back());
  });
  CHECK(peak >= big);
  CHECK(peak < 2 * big);  // an address sanitizer keeps what is freed
  CHECK(bench::peak_bytes([] {}) < slack);
}
