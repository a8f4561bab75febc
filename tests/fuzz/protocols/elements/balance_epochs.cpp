// A program whose phases are epochs requests a round between two of them, while elements are
// created on demand and end in every phase. The oracles: each element lives exactly in the phases
// that the draws give it; with `rotate` it is one PE further each time.
#include "runtime/balance.hpp"
#include "runtime/balance/strategy.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <array>
#include <map>

namespace tess::fuzz {
namespace {

using PhasesOf = std::map<std::int32_t, std::vector<std::int32_t>>;  // by element

struct Phases {
  std::uint64_t seed = 0;
  int n_phases = 1, n_first = 1;
  double create_chance = 0, destroy_chance = 0;
  bool rotates = false;
  PhasesOf lived{};

  [[nodiscard]] bool draw(std::int32_t element, std::int32_t phase, double chance) const {
    return Random(mix(seed ^ mix(static_cast<std::uint64_t>(element) * 64U +
                                 static_cast<std::uint64_t>(phase))))
        .chance(chance);
  }
  [[nodiscard]] bool creates(std::int32_t element, std::int32_t phase) const {
    return element < 1000 && draw(element, phase, create_chance);
  }
  [[nodiscard]] bool ends(std::int32_t element, std::int32_t phase) const {
    return draw(element, phase + 32, destroy_chance);
  }
  [[nodiscard]] static std::int32_t child(std::int32_t element, std::int32_t phase) {
    return 16 * (element + 1) + phase;
  }
  void expect_life(PhasesOf& expected, std::int32_t element, std::int32_t first) const {
    for (std::int32_t phase = first; phase < n_phases; ++phase) {
      expected[element].push_back(phase);
      if (creates(element, phase)) expect_life(expected, child(element, phase), phase + 1);
      if (ends(element, phase)) return;
    }
  }
};
Phases* phases_of_case = nullptr;

class EpochElement : public Chare<EpochElement, Index1> {
 public:
  void create(std::int32_t first_phase) { first_phase_ = first_phase; }
  void live(std::int32_t phase);
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  void serialize(auto& ar) { ar(first_phase_, was_on_); }

 private:
  std::int32_t first_phase_ = 1 << 20;
  PeId was_on_{-1};
};

void EpochElement::live(std::int32_t phase) {
  if (phase < first_phase_) return;
  Phases& phases = *phases_of_case;
  const std::int32_t me = index().x;
  locked([&] { phases.lived[me].push_back(phase); });
  if (phases.rotates && was_on_.value >= 0)
    expect(tess::my_pe().value == (was_on_.value + 1) % tess::n_pes(), element_text(*this),
           " was on ", was_on_, " before the round, and is on ", tess::my_pe());
  was_on_ = tess::my_pe();
  charge(std::chrono::microseconds(1 + me % 5));
  if (phases.creates(me, phase))
    array()[{Phases::child(me, phase)}].send_or_create_here<&EpochElement::create>(phase + 1);
  if (phases.ends(me, phase)) destroy();
}

Task live_all(Phases& phases, BalanceOptions options) {
  ArrayProxy<EpochElement> elements;
  BalancerProxy balancer;
  co_await epoch([&] {
    elements = create<EpochElement>(sparse);
    balancer = start_balancing(elements, options);
  });
  co_await epoch([&] {
    for (std::int32_t i = 0; i < phases.n_first; ++i)
      elements[{i}].send_or_create_home<&EpochElement::create>(0);
  });
  for (std::int32_t phase = 0; phase < phases.n_phases; ++phase) {
    co_await epoch([&] { elements.broadcast<&EpochElement::live>(phase); });
    co_await balancer.round();
  }
  if (options.when == BalanceWhen::at_sync)
    expect(balancer.history().size() == static_cast<std::size_t>(phases.n_phases),
           balancer.history().size(), " rounds for ", phases.n_phases, " phases");
}

}  // namespace

void balance_epochs(Case& test) {
  Phases phases{test.seed};
  phases_of_case = &phases;
  phases.n_phases = test.draw(1, 12);
  phases.n_first = test.draw(0, 12);
  phases.create_chance = 0.1 * test.draw(0, 3);
  phases.destroy_chance = 0.1 * test.draw(0, 3);
  BalanceOptions options;
  if (test.draw(0, 1) == 0) {
    options.strategy = "rotate";
    phases.rotates = true;
    test.machine.migration = 0;
  } else {
    options.strategy = any_of(balance::strategy_names(), test.random);
    if (test.draw(0, 2) == 0) options.when = BalanceWhen::automatic;
  }
  test.run_clean([&] { return live_all(phases, options); });
  PhasesOf expected;
  for (std::int32_t i = 0; i < phases.n_first; ++i) phases.expect_life(expected, i, 0);
  expect(phases.lived == expected, phases.lived.size(), " elements lived, ", expected.size(),
         " were to, or in other phases; strategy ", options.strategy);
}

}  // namespace tess::fuzz
