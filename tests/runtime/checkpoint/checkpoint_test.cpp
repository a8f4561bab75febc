// Checkpoints on one number of PEs and restarts on another, under any schedule.
#include "runtime/checkpoint.hpp"

#include "runtime/machine/threads.hpp"
#include "tests/runtime/checkpoint/world.hpp"
#include "tests/support/adversarial.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <cstdlib>

namespace {

constexpr std::int32_t n_steps = 9;

/// It does not print that messages to destroyed words were not delivered.
tess::Setup quiet_machine(int n_pes, std::uint64_t seed) {
  auto setup = tess::test::adversarial(n_pes, seed);
  setup.options.report = [](const std::string& line) {
    if (line.find("were not delivered") == std::string::npos) FAIL_CHECK(line);
  };
  return setup;
}

tess::Task run_through(std::uint64_t& log) {
  world::State state;
  co_await world::make(state);
  co_await world::steps(state, n_steps);
  log = state.log;
}

tess::Task run_to(std::string folder, std::int32_t step) {
  world::State state;
  co_await world::make(state);
  co_await world::steps(state, step);
  co_await tess::checkpoint(folder, state);
}

tess::Task continue_from(std::string folder, std::int32_t step, std::uint64_t& log) {
  auto state = co_await tess::restart<world::State>(folder);
  co_await world::steps(state, step);
  log = state.log;
  co_await tess::checkpoint(folder, state);
}

std::uint64_t reference() {
  static const std::uint64_t log = [] {
    std::uint64_t found = 0;
    auto setup = quiet_machine(3, 1);
    REQUIRE(tess::run(setup, [&] { return run_through(found); }) == 0);
    return found;
  }();
  return log;
}

std::uint64_t n_seeds() {
  const char* const given = std::getenv("TESS_SEEDS");
  return given != nullptr ? std::strtoull(given, nullptr, 10) : 60;
}

}  // namespace

TEST_CASE("a run that restarts on another number of PEs has the results of one that never stopped",
          "[runtime][checkpoint]") {
  const std::uint64_t expected = reference();
  for (std::uint64_t seed = 0; seed < n_seeds(); ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    const auto draw = [&](std::uint64_t what, std::uint64_t n) {
      return static_cast<int>(tess::mix(seed * 8 + what) % n);
    };
    const std::int32_t first = 1 + draw(0, n_steps - 2);
    const std::int32_t second = first + 1 + draw(1, static_cast<std::uint64_t>(n_steps - first));
    auto setup = quiet_machine(1 + draw(2, 7), seed);
    REQUIRE(tess::run(setup, [&] { return run_to(folder, first); }) == 0);
    std::uint64_t log = 0;
    auto next = quiet_machine(1 + draw(3, 7), seed + 1000);
    REQUIRE(tess::run(next, [&] { return continue_from(folder, second, log); }) == 0);
    auto last = quiet_machine(1 + draw(4, 7), seed + 2000);
    REQUIRE(tess::run(last, [&] { return continue_from(folder, n_steps, log); }) == 0);
    REQUIRE(log == expected);
  }
}

TEST_CASE("a run goes on after a checkpoint as if there had been none", "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    std::uint64_t log = 0;
    auto setup = quiet_machine(4, seed);
    struct Run {
      static tess::Task main(const std::string& in, std::uint64_t& found) {
        world::State state;
        co_await world::make(state);
        while (state.step < n_steps) {
          co_await world::advance(state);
          co_await tess::checkpoint(in, state);
        }
        found = state.log;
      }
    };
    REQUIRE(tess::run(setup, [&] { return Run::main(folder, log); }) == 0);
    REQUIRE(log == reference());
  }
}

TEST_CASE("a run restarts on other threads", "[runtime][checkpoint]") {
  const std::uint64_t expected = reference();
  const auto threads = [](int n_pes) {
    tess::Setup setup{tess::make_threads_machine(n_pes), {}};
    setup.options.report = quiet_machine(1, 1).options.report;
    return setup;
  };
  for (int i = 0; i < 6; ++i) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    auto setup = threads(1 + i % 4);
    REQUIRE(tess::run(setup, [&] { return run_to(folder, 2 + i); }) == 0);
    std::uint64_t log = 0;
    auto next = threads(4 - i % 3);
    REQUIRE(tess::run(next, [&] { return continue_from(folder, n_steps, log); }) == 0);
    CHECK(log == expected);
  }
}
