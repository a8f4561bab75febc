#include "runtime/machine/threads.hpp"

#include "runtime/core/error.hpp"
#include "tests/runtime/machine/mock_program.hpp"
#include "tests/support/catch.hpp"

namespace tess::detail {
namespace {

TEST_CASE("every token makes its tour on threads", "[runtime][machine]") {
  const std::int32_t n_pes = GENERATE(1, 2, 4, 8);
  const auto machine = make_threads_machine(n_pes);
  CAPTURE(machine->describe());
  REQUIRE(machine->n_pes() == n_pes);
  test::Tour tour(*machine, {.n_tokens = 20, .n_hops = 500});
  machine->run(tour);
  CHECK(tour.n_ended == 20 * n_pes);
  CHECK(tour.n_hops_made() == std::int64_t{20} * 500 * n_pes);
  CHECK(tour.n_misplaced == 0);
}

// One token: every PE but one is at rest at any time, so each hop wakes a sleeper sooner or later.
TEST_CASE("a single token wakes every PE it visits", "[runtime][machine]") {
  const auto machine = make_threads_machine(4);
  test::Tour tour(*machine, {.n_tokens = 1, .n_hops = 3000});
  machine->run(tour);
  CHECK(tour.n_hops_made() == 4 * 3000);
}

TEST_CASE("a machine stops in the middle of a flood", "[runtime][machine]") {
  const std::int32_t n_pes = GENERATE(1, 2, 4, 8);
  const auto machine = make_threads_machine(n_pes);
  test::Tour tour(*machine, {.n_tokens = 50, .n_hops = 1000, .stop_early = true});
  machine->run(tour);
  CHECK(tour.n_hops_made() < std::int64_t{50} * 1000 * n_pes);  // and asan finds no token lost
}

TEST_CASE("two machines of one process run one after the other", "[runtime][machine]") {
  for (int round = 0; round < 20; ++round) {
    const auto machine = make_threads_machine(0);
    CHECK(machine->n_pes() >= 1);
    test::Tour tour(*machine, {.n_tokens = 2, .n_hops = 5});
    machine->run(tour);
    CHECK(tour.n_ended == 2 * machine->n_pes());
  }
}

TEST_CASE("a negative number of PEs is refused", "[runtime][machine]") {
  CHECK_THROWS_AS(make_threads_machine(-1), Error);
}

}  // namespace
}  // namespace tess::detail
