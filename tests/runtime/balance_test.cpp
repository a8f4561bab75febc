// Rounds of whole runs on the simulated machine: several balanced arrays at once, and seeds.
#include "runtime/balance.hpp"

#include "runtime/balance/strategy.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess;

constexpr int n_phases = 6;

/// An element whose work grows with its index.
class Graded : public Chare<Graded> {
 public:
  void begin(Callback<int> target) {
    target_ = target;
    work();
  }
  void work() {
    charge(std::chrono::milliseconds(index().x + 1));
    ++phase_;
    at_sync();
  }
  void resume_from_sync() {
    if (phase_ < n_phases) return work();
    contribute(sum, 1, target_);
  }
  void serialize(auto& ar) { ar(phase_, target_); }

 private:
  int phase_ = 0;
  Callback<int> target_;
};

using History = std::vector<balance::Round>;

/// The rounds of arrays of 32 elements that are balanced at the same time.
Task balance_arrays(std::size_t n_arrays, BalanceOptions options, balance::Strategy users,
                    std::vector<History>& histories) {
  std::vector<BalancerProxy> balancers;
  std::vector<Future<int>> done(n_arrays);
  for (const Future<int>& one : done) {
    const auto array = create<Graded>(range(32));
    balancers.push_back(users ? start_balancing(array, options, users)
                              : start_balancing(array, options));
    array.broadcast<&Graded::begin>(one.callback());
  }
  for (Future<int>& one : done) {
    const int n_done = co_await one;
    CHECK(n_done == 32);
  }
  for (const BalancerProxy& one : balancers) histories.push_back(one.history());
}

std::vector<History> rounds_of(std::size_t n_arrays, const BalanceOptions& options,
                               const balance::Strategy& users = {}) {
  std::vector<History> histories;
  const test::Machine machine{
      .pes = 4, .per_process = 4, .seed = 0, .reordering = 0, .migration = 0};
  machine.run([&] { return balance_arrays(n_arrays, options, users, histories); })
      .require_success();
  return histories;
}

}  // namespace

TEST_CASE("arrays that are balanced at the same time do not correct one imbalance twice",
          "[balance]") {
  for (const char* strategy : {"greedy_refine", "gossip"}) {
    INFO(strategy);
    for (const History& rounds : rounds_of(3, {.strategy = strategy})) {
      REQUIRE(rounds.size() == n_phases);
      CHECK(rounds.front().before > 1.5);
      CHECK(rounds.front().n_moved > 0);
      for (std::size_t k = 1; k < rounds.size(); ++k) {
        INFO("round " << k);
        CHECK(rounds[k].before < 1.1);
        CHECK(rounds[k].n_moved <= 2);
      }
    }
  }
}

TEST_CASE("with periodic rounds at_sync() is no barrier", "[balance]") {
  const std::vector<History> histories =
      rounds_of(2, {.when = BalanceWhen::periodic, .period = std::chrono::milliseconds(40)});
  for (const History& rounds : histories) {
    REQUIRE(!rounds.empty());
    CHECK(rounds.front().n_moved > 0);
  }
}

TEST_CASE("the time of a strategy is no load of the next phase", "[balance]") {
  // The strategy takes longer than a phase, while all elements wait.
  const History rounds = rounds_of(1, {}, [](const balance::Snapshot& s) {
                           charge(std::chrono::seconds(1));
                           return balance::make_strategy("greedy_refine", 1)(s);
                         }).front();
  REQUIRE(rounds.size() == n_phases);
  for (std::size_t k = 1; k < rounds.size(); ++k) {
    INFO("round " << k);
    CHECK(rounds[k].before < 1.1);
    CHECK(rounds[k].n_moved == 0);
  }
}

namespace {

/// It takes a second to pack, and another one to unpack.
class Bulky : public Chare<Bulky> {
 public:
  void work() { charge(std::chrono::milliseconds(100)); }
  void serialize(auto& /*ar*/) { charge(std::chrono::seconds(1)); }
};

/// Rounds between which the elements work, all of which each round sends to the next PE. `seen`: the
/// background of the PEs, which each round sees.
Task move_all_around(std::vector<std::vector<double>>& seen) {
  const auto all = create<Bulky>(range(8));
  const auto to_next = [&seen](const balance::Snapshot& s) {
    seen.push_back(s.pes.background);
    balance::Assignment next = s.elements.pe;
    for (PeId& pe : next) pe.value = (pe.value + 1) % n_pes();
    return next;
  };
  const BalancerProxy balancer = start_balancing(all, {}, to_next);
  co_await balancer.begin_phase();
  for (int round = 0; round < 4; ++round) {
    co_await epoch([&] { all.broadcast<&Bulky::work>(); });
    co_await balancer.round();
  }
}

}  // namespace

TEST_CASE("what the moves of a round cost is no background of the next phase, on any PE",
          "[balance]") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    std::vector<std::vector<double>> seen;
    const test::Machine machine{.pes = 4, .per_process = 1, .seed = seed, .migration = 0};
    machine.run([&] { return move_all_around(seen); }).require_success();
    REQUIRE(seen.size() == 4);
    for (std::size_t round = 0; round < seen.size(); ++round)
      for (const double background : seen[round]) {
        CAPTURE(round);
        CHECK(background < 0.1);
      }
  }
}

TEST_CASE("a round of gossip depends on the seed, and on nothing else", "[balance]") {
  const auto moved = [](std::uint64_t seed) {
    std::vector<std::pair<std::size_t, double>> result;
    const std::vector<History> histories = rounds_of(1, {.strategy = "gossip", .seed = seed});
    for (const balance::Round& round : histories.front())
      result.emplace_back(round.n_moved, round.predicted);
    return result;
  };
  const auto first = moved(1);
  CHECK(moved(1) == first);
  bool differs = false;
  for (std::uint64_t seed = 2; seed < 6; ++seed) differs = differs || moved(seed) != first;
  CHECK(differs);
}
