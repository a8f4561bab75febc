#include "runtime/pe/queues/outbox.hpp"

#include "tests/support/catch.hpp"

TEST_CASE("a large memory for messages gives as much credit", "[runtime][scheduler]") {
  using tess::detail::credit_of;
  using tess::detail::credits;
  constexpr std::uint64_t gib = std::uint64_t{1} << 30U;
  CHECK(credits(64 * gib) == 4 * gib + 1);
  CHECK(credit_of(1000) == 63);
  CHECK(credit_of(60 * gib) == credits(60 * gib));
  CHECK(credit_of(64 * gib) == ~std::uint32_t{0});
}
