// Checkpoints on one number of PEs and restarts on another, under any schedule.
#include "runtime/checkpoint.hpp"

#include "runtime/more/when.hpp"
#include "runtime/timer.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/runtime/checkpoint/world.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/scratch.hpp"

namespace {

constexpr std::int32_t n_steps = 9;

/// A run that reports nothing.
void quiet(int n_pes, std::uint64_t seed, const tess::test::Main& main) {
  CHECK(tess::test::completes(n_pes, seed, main).empty());
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
    quiet(3, 1, [&] { return run_through(found); });
    return found;
  }();
  return log;
}

}  // namespace

TEST_CASE("a run that restarts on another number of PEs has the results of one that never stopped",
          "[runtime][checkpoint]") {
  const std::uint64_t expected = reference();
  for (std::uint64_t seed = 0; seed < tess::test::n_seeds(60); ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    const auto draw = [&](std::uint64_t what, std::uint64_t n) {
      return static_cast<int>(tess::mix(seed * 8 + what) % n);
    };
    const std::int32_t first = 1 + draw(0, n_steps - 2);
    const std::int32_t second = first + 1 + draw(1, static_cast<std::uint64_t>(n_steps - first));
    quiet(1 + draw(2, 7), seed, [&] { return run_to(folder, first); });
    std::uint64_t log = 0;
    quiet(1 + draw(3, 7), seed + 1000, [&] { return continue_from(folder, second, log); });
    quiet(1 + draw(4, 7), seed + 2000, [&] { return continue_from(folder, n_steps, log); });
    REQUIRE(log == expected);
  }
}

TEST_CASE("a run goes on after a checkpoint as if there had been none", "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    std::uint64_t log = 0;
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
    quiet(4, seed, [&] { return Run::main(folder, log); });
    REQUIRE(log == reference());
  }
}

TEST_CASE("a run restarts on other threads", "[runtime][checkpoint]") {
  const std::uint64_t expected = reference();
  const auto on_threads = [](int n_pes, const tess::test::Main& main) {
    CHECK(tess::test::completes_on({tess::make_threads_machine(n_pes), {}}, main).empty());
  };
  for (int i = 0; i < 6; ++i) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    on_threads(1 + i % 4, [&] { return run_to(folder, 2 + i); });
    std::uint64_t log = 0;
    on_threads(4 - i % 3, [&] { return continue_from(folder, n_steps, log); });
    CHECK(log == expected);
  }
}

namespace {

class CountsSteps : public tess::Chare<CountsSteps> {
 public:
  void step(tess::Callback<int> target) { contribute(tess::sum, ++n_, std::move(target)); }
  void report(tess::Callback<int> target) { contribute(tess::sum, n_, std::move(target)); }
  void serialize(auto& ar) { ar(n_); }

 private:
  int n_ = 0;
};

struct Totals {
  tess::ArrayProxy<CountsSteps> cells;
  int total = 0;

  tess::Task step() {
    const int found = co_await cells.reduce<&CountsSteps::step>();
    total += found;
  }
  static tess::Task save_beside_a_step(const std::string& folder) {
    Totals state;
    state.cells = tess::create<CountsSteps>(tess::range(4));
    tess::Task step = state.step();
    co_await tess::checkpoint(folder, state);
    co_await step;
  }
  static tess::Task restart(const std::string& folder, int& total, int& in_cells) {
    const auto state = co_await tess::restart<Totals>(folder);
    in_cells = co_await state.cells.reduce<&CountsSteps::report>();
    total = state.total;
  }
};

/// Each member makes an array of its own and a timer where it is constructed.
class MakesAtOnce : public tess::Group<MakesAtOnce> {
 public:
  MakesAtOnce() : cells_(tess::create<CountsSteps>(tess::range(3))) {
    tick_ = tess::every(std::chrono::milliseconds(1), [this] { ++n_ticks_; });
  }
  void step(tess::Callback<int> target) { cells_.broadcast<&CountsSteps::step>(std::move(target)); }
  void stop(tess::Timer of_before) {
    of_before.cancel();
    n_ticks_ = 0;
  }
  [[nodiscard]] int n_ticks() const { return n_ticks_; }
  void end() { tick_.cancel(); }
  void serialize(auto& ar) { ar(cells_); }

 private:
  tess::ArrayProxy<CountsSteps> cells_;
  tess::Timer tick_;
  int n_ticks_ = 0;
};

struct Made {
  tess::GroupProxy<MakesAtOnce> makers;
  void serialize(auto& ar) { ar(makers); }

  static tess::Task save(const std::string& folder) {
    Made state;
    co_await tess::epoch([&] { state.makers = tess::create<MakesAtOnce>(tess::each_pe); });
    co_await state.step();
    co_await tess::checkpoint(folder, state);
    state.makers.broadcast<&MakesAtOnce::end>();
  }
  static tess::Task restart(const std::string& folder, int& sum, int& n_ticks) {
    auto state = co_await tess::restart<Made>(folder);
    co_await state.step();
    sum = state.sum;
    // A timer of the saved run has the number 1 on its PE.
    state.makers[tess::PeId{1}].send<&MakesAtOnce::stop>(tess::Timer(tess::PeId{1}, 1));
    co_await tess::sleep(std::chrono::milliseconds(20));
    n_ticks = co_await state.makers[tess::PeId{1}].ask<&MakesAtOnce::n_ticks>();
    state.makers.broadcast<&MakesAtOnce::end>();
  }
  tess::Task step() {
    for (std::int32_t pe = 0; pe < tess::n_pes(); ++pe) {
      tess::Future<int> one;
      makers[tess::PeId{pe}].send<&MakesAtOnce::step>(one.callback());
      sum += co_await one;
    }
  }
  int sum = 0;
};

}  // namespace

TEST_CASE("a checkpoint has the state as it is when the elements are saved",
          "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    quiet(3, seed, [&] { return Totals::save_beside_a_step(folder); });
    int total = 0, in_cells = 0;
    quiet(2, seed, [&] { return Totals::restart(folder, total, in_cells); });
    CHECK(total == 4);
    CHECK(in_cells == 4);
  }
}

TEST_CASE("what constructors make in a restart has no number of the saved run",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  quiet(3, 0, [&] { return Made::save(folder); });
  int sum = 0, n_ticks = 0;
  quiet(3, 0, [&] { return Made::restart(folder, sum, n_ticks); });
  CHECK(sum == 3 * 3 * 2);
  CHECK(n_ticks > 3);
}
