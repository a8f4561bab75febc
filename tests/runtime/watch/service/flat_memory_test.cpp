// Timers that are cancelled leave no memory behind, as the system sees it.
#include "runtime/runtime.hpp"
#include "runtime/timer.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/resident.hpp"

namespace {

TEST_CASE("a million timers that are cancelled long before they are due leave memory flat",
          "[runtime][timers]") {
  tess::test::Growth growth(100);
  tess::Setup setup{tess::make_threads_machine(1), {}};
  const auto main = [&growth] {
    for (int round = 1; round <= growth.n_rounds(); ++round) {
      std::vector<tess::Timer> timers;
      for (int i = 0; i < 10'000; ++i)
        timers.push_back(tess::after(std::chrono::hours(1), [] { std::abort(); }));
      for (const tess::Timer& timer : timers) timer.cancel();
      growth.after(round);
    }
  };
  REQUIRE(tess::run(setup, main) == 0);
  INFO("grows by " << growth.bytes() << " bytes over three quarters of a million timers");
  REQUIRE(growth.bytes() >= 0);
  CHECK(growth.bytes() < 1 << 20);
}

}  // namespace
