// A program that balances only if it is asked to has one course for both.
#include "runtime/balance.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess;

class Worker : public Chare<Worker, Index1> {
 public:
  void work() { (void)charge(std::chrono::microseconds(index().x)); }
  void serialize(auto& /*ar*/) {}
};

/// Three phases; the number of rounds.
Task run_phases(bool balanced, std::size_t& n_rounds) {
  const auto workers = create<Worker>(range(16));
  BalancerProxy balancer;
  if (balanced) balancer = start_balancing(workers, {.strategy = "greedy"});
  co_await balancer.place_again();
  co_await balancer.begin_phase();
  for (int phase = 0; phase < 3; ++phase) {
    co_await epoch([&] { workers.broadcast<&Worker::work>(); });
    co_await balancer.round();
  }
  n_rounds = balancer.history().size();
}

}  // namespace

TEST_CASE("the rounds of a balancer of no array return at once, and leave no history",
          "[balance]") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    INFO("seed " << seed);
    const test::Machine machine{.pes = 3, .seed = seed};
    std::size_t n_rounds = 7;
    machine.run([&] { return run_phases(false, n_rounds); }).require_success();
    CHECK(n_rounds == 0);
    machine.run([&] { return run_phases(true, n_rounds); }).require_success();
    CHECK(n_rounds > 0);
  }
}
