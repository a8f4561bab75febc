#include "runtime/wire/machine/threads.hpp"

#include "runtime/core/error.hpp"
#include "tests/runtime/wire/machine/mock_program.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <thread>

namespace tess::detail {
namespace {

/// A PE that always has messages ready, of a millisecond each or of none, and stops after some
/// steps.
class Steps final : public Program {
 public:
  Steps(Machine& machine, std::chrono::milliseconds each, std::size_t n_steps)
      : machine_(machine), each_(each), n_steps_(n_steps) {}

  void start(PeId) override {}
  void accept(PeId, Link*) override {}
  std::size_t step(PeId, std::size_t most) override {
    longest = std::max(longest, most);
    if (each_.count() > 0) std::this_thread::sleep_for(each_ * most);
    if (++n_taken == n_steps_ || (each_.count() == 0 && longest > 1)) machine_.stop();
    return most;
  }
  bool idle(PeId) override { return false; }
  void busy(PeId) override { ++n_busy; }
  void receive(PeId, std::span<const std::byte>) override {}
  void finish(PeId) override {}

  std::size_t longest = 0, n_taken = 0, n_busy = 0;

 private:
  Machine& machine_;
  const std::chrono::milliseconds each_;
  const std::size_t n_steps_;
};

TEST_CASE("a PE checks its inbox after each message that runs long, and is reported as busy",
          "[runtime][machine]") {
  const auto machine = make_threads_machine(1);
  Steps steps(*machine, std::chrono::milliseconds(1), 10);
  machine->run(steps);
  CHECK(steps.longest == 1);
  CHECK(steps.n_busy == steps.n_taken);
}

TEST_CASE("steps of short messages grow", "[runtime][machine]") {
  const auto machine = make_threads_machine(1);
  Steps steps(*machine, std::chrono::milliseconds(0), 1'000'000);
  machine->run(steps);
  CHECK(steps.longest > 1);
}

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
