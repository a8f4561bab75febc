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
       "array Phased: balance strategy: returned 11 PEs for 12 elements"},
      {[](const Snapshot& /*s*/) { return Assignment(); },
       "array Phased: balance strategy: returned 0 PEs for 12 elements"},
      {[](const Snapshot& s) { return Assignment(s.elements.size(), PeId{99}); },
       "array Phased: balance strategy: element 0 to PE 99; choose one of 4"},
      {[](const Snapshot& s) { return Assignment(s.elements.size(), PeId{-1}); },
       "array Phased: balance strategy: element 0 to PE -1; choose one of 4"},
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
