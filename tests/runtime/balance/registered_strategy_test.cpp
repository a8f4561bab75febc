// A strategy that the program registers under a name. Not in test_balance, which tries all names.
#include "runtime/balance.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

namespace {

using tess::balance::Assignment, tess::balance::register_strategy, tess::balance::Snapshot;

class Phases : public tess::Chare<Phases> {
 public:
  void begin(tess::Callback<void> target) {
    target_ = target;
    work();
  }
  void work() {
    tess::charge(std::chrono::milliseconds(1));
    ++phase_;
    at_sync();
  }
  void resume_from_sync() { phase_ < 4 ? work() : contribute(target_); }
  void serialize(auto& ar) { ar(phase_, target_); }

 private:
  int phase_ = 0;
  tess::Callback<void> target_;
};

}  // namespace

TEST_CASE("a registered strategy has a name like any other", "[balance]") {
  register_strategy("all_on_2",
                    [](const Snapshot& s) { return Assignment(s.elements.size(), tess::PeId{2}); });
  CHECK(tess::balance::strategy_names().back() == "all_on_2");
  std::vector<tess::balance::Round> rounds;
  CHECK(tests::run("pes=4,cost=100ns", [&rounds]() -> tess::Task {
          const auto chares = tess::create<Phases>(tess::range(12));
          const auto balancer =
              tess::start_balancing(chares, tess::parse_balance("all_on_2,seed=2"));
          co_await chares.reduce<&Phases::begin>();
          rounds = balancer.history();
        }).exit_code == 0);
  REQUIRE(rounds.size() >= 2);
  CHECK(rounds[0].strategy == "all_on_2");
  CHECK(rounds[0].n_moved == 9);
  CHECK(rounds[1].n_moved == 0);
}

TEST_CASE("a strategy that cannot be registered is refused", "[balance]") {
  const auto stay = [](const Snapshot& s) { return s.elements.pe; };
  CHECK_THROWS_WITH(register_strategy("greedy", stay),
                    Contains("greedy: there is a strategy of this name"));
  for (const char* name : {"", "all", "a,b", "a=b", "a b"})
    CHECK_THROWS_WITH(register_strategy(name, stay), Contains("is no name of a strategy"));
  CHECK_THROWS_WITH(register_strategy("empty", {}), Contains("function is empty"));
  CHECK_THROWS_WITH(register_strategy("old", stay, tess::balance::snapshot_version + 1),
                    Contains("another version of Tessera"));
  CHECK_THROWS_WITH(tess::parse_balance("old"), Contains("choose one of none"));
}
