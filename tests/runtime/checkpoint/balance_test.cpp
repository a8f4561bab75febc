// The measured loads of elements in checkpoints: after a restart on another number of PEs the first
// round places the elements as well as rounds did before.
#include "runtime/balance.hpp"

#include "runtime/checkpoint.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <atomic>
#include <thread>

namespace {

/// The element at x costs x + 1 us per phase.
class Brick : public tess::Chare<Brick> {
 public:
  Brick() = default;
  void work(const tess::Callback<int>& done) {
    (void)tess::charge(std::chrono::microseconds(index().x + 1));
    contribute(tess::sum, 1, done);
  }
  /// Ends after a call in which the thread slept: the meter takes that time back.
  void sleep_and_end() {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    destroy();
    ++n_ended;
  }
  static inline std::atomic<int> n_ended = 0;
  void serialize(auto& ar) { ar(weight_); }

 private:
  int weight_ = 1;
};

struct Bricks {
  tess::ArrayProxy<Brick> bricks;
};

tess::Task phase(tess::ArrayProxy<Brick> bricks) {
  co_await bricks.reduce<&Brick::work>();
}

using Rounds = std::vector<tess::balance::Round>;

/// Some phases with a round after each, then phases without one, then a checkpoint.
tess::Task save(std::string folder, int n_rounds, int n_more) {
  Bricks state;
  state.bricks = tess::create<Brick>(tess::range(60));
  std::optional<tess::BalancerProxy> balancer;
  if (n_rounds + n_more > 0) balancer = tess::start_balancing(state.bricks, {.strategy = "greedy"});
  for (int n = 0; n < n_rounds; ++n) {
    co_await phase(state.bricks);
    co_await balancer->round();
  }
  for (int n = 0; n < n_more; ++n) co_await phase(state.bricks);
  co_await tess::checkpoint(folder, state);
}

/// A restart, a phase, and a round that shows how it was balanced.
tess::Task go_on(std::string folder, std::string strategy, bool places, Rounds& rounds) {
  const auto state = co_await tess::restart<Bricks>(folder);
  tess::BalanceOptions options;
  options.strategy = strategy;
  const tess::BalancerProxy balancer = tess::start_balancing(state.bricks, options);
  if (places) {
    co_await balancer.place_again();
  } else {
    co_await balancer.begin_phase();
  }
  co_await phase(state.bricks);
  co_await balancer.round();
  rounds = balancer.history();
}

/// Fixed costs, so that loads are the same in every run.
tess::Setup machine(int n_pes) {
  tess::SimulatedOptions options;
  options.n_pes = n_pes;
  options.cost = tess::Time(10);
  return {tess::make_simulated_machine(options), {}};
}

Rounds after_restart(int n_rounds, int n_more, bool places, int n_pes = 3,
                     const std::string& strategy = "greedy") {
  const tess::test::Scratch scratch;
  auto first = machine(4);
  REQUIRE(tess::run(first, [&] { return save(scratch.path("saved"), n_rounds, n_more); }) == 0);
  Rounds rounds;
  auto second = machine(n_pes);
  REQUIRE(tess::run(second,
                    [&] { return go_on(scratch.path("saved"), strategy, places, rounds); }) == 0);
  return rounds;
}

}  // namespace

TEST_CASE("a restarted run balances by the loads of the checkpoint before its first phase",
          "[runtime][checkpoint][balance]") {
  // Without them the phase runs on the homes of the elements: the last third has 5/9 of the load.
  const Rounds without = after_restart(2, 1, false);
  REQUIRE(without.size() == 1);
  CHECK(without[0].before > 1.5);
  // After a whole phase, right after a round, in the first phase of all, on other numbers of PEs.
  for (const auto& [n_rounds, n_more, n_pes] :
       {std::array{2, 1, 3}, std::array{2, 0, 3}, std::array{1, 0, 7}, std::array{0, 1, 2},
        std::array{3, 2, 5}}) {
    INFO(n_rounds << " rounds, " << n_more << " phases more, " << n_pes << " PEs");
    const Rounds rounds = after_restart(n_rounds, n_more, true, n_pes);
    REQUIRE(rounds.size() == 2);
    CHECK(rounds[0].n_elements == 60);
    CHECK(rounds[0].n_unknown == 0);
    CHECK(rounds[0].n_moved > 0);
    CHECK(rounds[0].predicted < 1.1);
    CHECK(rounds[1].before < 1.1);  // as the first phase was measured
    CHECK(rounds[1].n_unknown == 0);
  }
}

TEST_CASE("strategies that run distributed use the loads of a checkpoint, too",
          "[runtime][checkpoint][balance]") {
  for (const char* strategy : {"diffusion", "gossip"}) {
    const Rounds rounds = after_restart(2, 0, true, 3, strategy);
    REQUIRE(rounds.size() == 2);
    INFO(strategy);
    CHECK(rounds[0].n_moved > 0);
    CHECK(rounds[1].before < 1.3);
  }
}

TEST_CASE("without loads in the checkpoint nothing moves, and the first phase is measured",
          "[runtime][checkpoint][balance]") {
  const Rounds rounds = after_restart(0, 0, true);
  REQUIRE(rounds.size() == 1);
  CHECK(rounds[0].n_unknown == 0);
  CHECK(rounds[0].before > 1.5);
}

// Under AddressSanitizer: the meter wrote to the records of elements that had ended.
TEST_CASE("elements that were balanced before a restart end where nothing balances them",
          "[runtime][checkpoint][balance]") {
  const tess::test::Scratch scratch;
  auto first = machine(4);
  REQUIRE(tess::run(first, [&] { return save(scratch.path("saved"), 2, 1); }) == 0);
  tess::Setup second{tess::make_threads_machine(2), {}};
  second.options.statistics = true;  // so that each PE has a meter
  second.options.report = [](const std::string&) {};
  Brick::n_ended = 0;
  REQUIRE(tess::run(second, [&]() -> tess::Task {
            const auto state = co_await tess::restart<Bricks>(scratch.path("saved"));
            co_await tess::epoch([&] { state.bricks.broadcast<&Brick::sleep_and_end>(); });
          }) == 0);
  CHECK(Brick::n_ended == 60);
}
