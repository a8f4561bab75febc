// A program whose phases are epochs requests a round between two of them, while elements are
// created on demand and end in every phase. The oracles: each element lives exactly in the phases
// that the draws give it; with `rotate` it is one PE further each time.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/balance.hpp"
#include "runtime/balance/strategy.hpp"

#include <array>
#include <map>

namespace tess::fuzz {
namespace {

using PhasesOf = std::map<std::int32_t, std::vector<std::int32_t>>;  // by element

struct Town {
  Trial& trial;
  int n_phases = 1, n_first = 1;
  double create_chance = 0, destroy_chance = 0;
  bool rotates = false;
  std::mutex mutex{};
  PhasesOf lived{};

  [[nodiscard]] bool draw(std::int32_t element, std::int32_t phase, double chance) const {
    return Random(mix(trial.seed() ^ mix(static_cast<std::uint64_t>(element) * 64U +
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
Town* town_of_trial = nullptr;

class Citizen : public Chare<Citizen, Index1> {
 public:
  void create(std::int32_t first_phase) { first_phase_ = first_phase; }
  void live(std::int32_t phase);
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(first_phase_, was_on_);
  }

 private:
  std::int32_t first_phase_ = 1 << 20;
  PeId was_on_{-1};
};

void Citizen::live(std::int32_t phase) {
  if (phase < first_phase_) return;
  Town& town = *town_of_trial;
  const std::int32_t me = index().x;
  {
    const std::lock_guard lock(town.mutex);
    town.lived[me].push_back(phase);
  }
  if (town.rotates && was_on_.value >= 0)
    town.trial.expect(tess::my_pe().value == (was_on_.value + 1) % tess::n_pes(),
                      element_text(*this), " was on ", was_on_, " before the round, and is on ",
                      tess::my_pe());
  was_on_ = tess::my_pe();
  charge(std::chrono::microseconds(1 + me % 5));
  if (town.creates(me, phase))
    array()[{Town::child(me, phase)}].send_or_create_here<&Citizen::create>(phase + 1);
  if (town.ends(me, phase)) destroy();
}

Task live_all(Town& town, BalanceOptions options) {
  ArrayProxy<Citizen> citizens;
  BalancerProxy balancer;
  co_await epoch([&] {
    citizens = create<Citizen>(sparse);
    balancer = start_balancing(citizens, options);
  });
  co_await epoch([&] {
    for (std::int32_t i = 0; i < town.n_first; ++i)
      citizens[{i}].send_or_create_home<&Citizen::create>(0);
  });
  for (std::int32_t phase = 0; phase < town.n_phases; ++phase) {
    co_await epoch([&] { citizens.broadcast<&Citizen::live>(phase); });
    co_await balancer.round();
  }
  if (options.when == BalanceWhen::at_sync)
    town.trial.expect(balancer.history().size() == static_cast<std::size_t>(town.n_phases),
                      balancer.history().size(), " rounds for ", town.n_phases, " phases");
}

}  // namespace

void balance_epochs(Trial& trial) {
  Town town{trial};
  town_of_trial = &town;
  town.n_phases = trial.draw(1, 12);
  town.n_first = trial.draw(0, 12);
  town.create_chance = 0.1 * trial.draw(0, 3);
  town.destroy_chance = 0.1 * trial.draw(0, 3);
  BalanceOptions options;
  if (trial.draw(0, 1) == 0) {
    options.strategy = "rotate";
    town.rotates = true;
    trial.forbid_forced_migration();
  } else {
    const auto& names = balance::strategy_names();
    options.strategy = names[trial.random().below(names.size())];
    if (trial.draw(0, 2) == 0) options.when = BalanceWhen::automatic;
  }
  trial.run_clean([&] { return live_all(town, options); });
  PhasesOf expected;
  for (std::int32_t i = 0; i < town.n_first; ++i) town.expect_life(expected, i, 0);
  trial.expect(town.lived == expected, town.lived.size(), " elements lived, ", expected.size(),
               " were to, or in other phases; strategy ", options.strategy);
}

}  // namespace tess::fuzz
