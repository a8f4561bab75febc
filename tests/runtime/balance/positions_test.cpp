// A strategy that needs positions is refused when balancing of a chare without any starts, before
// its elements have worked.
#include "runtime/balance.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess;

class Nowhere : public Chare<Nowhere, Index1> {
 public:
  void work() {}
  void serialize(auto& /*ar*/) {}
};

class Somewhere : public Chare<Somewhere, Index1> {
 public:
  void work() {}
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  void serialize(auto& /*ar*/) {}
};

/// A round of 16 elements; true once the balancer was accepted.
template <class C>
Task balance_once(std::string strategy, bool& accepted) {
  const auto all = create<C>(range(16));
  BalancerProxy balancer;
  co_await epoch([&] { balancer = start_balancing(all, {.strategy = strategy}); });
  accepted = true;
  co_await epoch([&] { all.template broadcast<&C::work>(); });
  co_await balancer.round();
}

}  // namespace

TEST_CASE("a strategy that needs positions is refused before any work", "[balance]") {
  for (const std::string strategy : {"rcb", "hilbert", "greedy", "none"}) {
    const bool by_position = strategy == "rcb" || strategy == "hilbert";
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      INFO(strategy << ", seed " << seed);
      const test::Machine machine{.pes = 4, .seed = seed};
      bool accepted = false;
      const test::Result refused =
          machine.run([&] { return balance_once<Nowhere>(strategy, accepted); });
      CHECK(accepted == !by_position);
      CHECK(refused.ok() == !by_position);
      if (by_position) {
        CHECK_THAT(refused.exception,
                   Catch::Contains("balance strategy " + strategy + ": elements") &&
                       Catch::Contains("Nowhere") && Catch::Contains("define balance_position()"));
      }
      machine.run([&] { return balance_once<Somewhere>(strategy, accepted); }).require_success();
    }
  }
}
