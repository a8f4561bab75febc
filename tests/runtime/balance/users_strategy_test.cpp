// A strategy of the user: what it returns is followed or refused, and the run ends.
#include "runtime/balance.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <stdexcept>

namespace {

using namespace tess;
using balance::Assignment;
using balance::Snapshot;

class Phased : public Chare<Phased> {
 public:
  void begin(Callback<int> target) {
    target_ = target;
    work();
  }
  void work() {
    charge(std::chrono::milliseconds(index().x));
    ++phase_;
    at_sync();
  }
  void resume_from_sync() {
    if (phase_ < 4) return work();
    contribute(sum, phase_, target_);
  }
  void serialize(auto& ar) { ar(phase_, target_); }

 private:
  int phase_ = 0;
  Callback<int> target_;
};

struct Outcome {
  int n_phases = 0;
  std::size_t n_moves = 0;
};

Task run_phases(balance::Strategy strategy, Outcome& outcome) {
  const auto chares = create<Phased>(range(12));
  const auto balancer = start_balancing(chares, {}, strategy);
  outcome.n_phases = co_await chares.reduce<&Phased::begin>();
  for (const balance::Round& round : balancer.history()) outcome.n_moves += round.n_moved;
}

test::Result run_with(const balance::Strategy& strategy, Outcome& outcome) {
  const test::Machine machine{.pes = 4, .seed = 3, .migration = 0};
  return machine.run([&] { return run_phases(strategy, outcome); });
}

}  // namespace

TEST_CASE("the assignment of a user's strategy is followed", "[balance]") {
  Outcome outcome;
  run_with([](const Snapshot& s) { return s.elements.pe; }, outcome).require_success();
  CHECK(outcome.n_phases == 48);
  CHECK(outcome.n_moves == 0);
  run_with([](const Snapshot& s) { return Assignment(s.elements.size(), PeId{3}); }, outcome)
      .require_success();
  CHECK(outcome.n_phases == 48);
  CHECK(outcome.n_moves == 9);
}

TEST_CASE("an assignment that is none ends the run with an error that says why", "[balance]") {
  const std::pair<balance::Strategy, std::string> wrong[] = {
      {[](const Snapshot& s) { return Assignment(s.elements.size() - 1); },
       "array Phased: balance strategy own: returned 11 PEs for 12 elements"},
      {[](const Snapshot& /*s*/) { return Assignment(); },
       "array Phased: balance strategy own: returned 0 PEs for 12 elements"},
      {[](const Snapshot& s) { return Assignment(s.elements.size(), PeId{99}); },
       "array Phased: balance strategy own: element 0 to PE 99; choose one of PE 0 … 3"},
      {[](const Snapshot& s) { return Assignment(s.elements.size(), PeId{-1}); },
       "array Phased: balance strategy own: element 0 to PE -1; choose one of PE 0 … 3"},
      {[](const Snapshot& s) {
         return Assignment(s.elements.size(), PeId{balance::Load::unknown().seconds() > 0 ? 1 : 0});
       },
       "array Phased: balance strategy: takes an unknown load for a number"},
      {[](const Snapshot& /*s*/) -> Assignment { throw std::runtime_error("no idea"); }, "no idea"},
      {balance::Strategy(), "the strategy is an empty function"},
  };
  for (const auto& [strategy, sentence] : wrong) {
    INFO(sentence);
    Outcome outcome;
    const test::Result result = run_with(strategy, outcome);
    CHECK(!result.ok());
    CHECK_THAT(result.exception, Catch::Contains(sentence));
    CHECK(outcome.n_phases == 0);
  }
}

TEST_CASE("the communication matrix of a snapshot, and what limits its phase", "[balance]") {
  Snapshot s;
  s.pes = {{0, 1}, {1, 1}, {0, 0}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    s.elements.key.push_back({CollectionId{7}, i});
    s.elements.pe.push_back(PeId{i == 2 ? 1 : 0});
    s.elements.load.push_back(i == 0 ? 5 : 1);
    s.elements.migratable.push_back(1);
    s.elements.size_bytes.push_back(1);
    s.elements.memory_bytes.push_back(1);
  }
  s.edges = {{0, 1, 100, 1}, {1, 2, 20, 1}, {2, 0, 3, 1}};
  balance::validate(s);
  using Matrix = std::vector<std::vector<std::uint64_t>>;
  CHECK(balance::bytes_between(s, s.elements.pe) == Matrix{{100, 20}, {3, 0}});
  CHECK(balance::bytes_between(s, {PeId{0}, PeId{1}, PeId{1}}) == Matrix{{0, 100}, {3, 20}});
  // 6 s and 2 s: the mean is 4 s.
  CHECK(
      describe(summarise(balance::loads_of_pes(s, s.elements.pe))) ==
      "PEs wait 33 % of the time; perfect balance would save 33 %; the largest element, number 0, "
      "allows 17 %");
  s.elements.index = {"[0]", "[1]", "[2]"};
  const auto beside = [](const Snapshot& of) { return Assignment(of.elements.size(), PeId{2}); };
  CHECK_THROWS_WITH(
      balance::make_strategy(beside, "beside")(s),
      Catch::Contains("strategy beside: element 0 [0] to PE 2; choose one of PE 0 … 1"));
}
