// The balancer's barrier, for elements that are created in awaited epochs: between phases by the
// main task, and within a phase by elements before they call at_sync(). The oracle: a round ends
// once exactly the elements that live in it have reached it.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/balance.hpp"
#include "runtime/balance/strategy.hpp"

#include <array>
#include <atomic>

namespace tess::fuzz {
namespace {

constexpr int most_eras = 6, most_phases = 3, most_rounds = most_eras * most_phases;

struct World {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_phases = 1;  // of an era
  double create_chance = 0, destroy_chance = 0, leave_chance = 0;
  std::atomic<int> n_created{0}, n_alive{0};
  std::array<std::atomic<int>, most_rounds> lives_in{}, reached{};

  /// So many live in `round` and in the rounds of its era after it, more than before.
  void change(int round, int by) {
    for (int r = round; r < end_of_era(round); ++r) lives_in[static_cast<std::size_t>(r)] += by;
  }
  [[nodiscard]] int end_of_era(int round) const { return (round / n_phases + 1) * n_phases; }
};
World* world = nullptr;

class Settler : public Chare<Settler, Index1> {
 public:
  Settler() = default;
  explicit Settler(int called_from) : called_from_(called_from) {}

  Task begin(int round) {
    if (!leaves_ && round >= called_from_)
      co_await run(round);  // else its creator has called it, or will
  }
  Task run(int round) {
    round_ = round;
    return phase();
  }
  Task resume_from_sync() {
    if (leaves_) co_return;  // it ends when the code that destroyed it is done
    const auto r = static_cast<std::size_t>(round_++);
    world->trial.expect(world->reached[r] == world->lives_in[r], element_text(*this),
                        " is past round ", r, ", in which ", world->lives_in[r].load(),
                        " live, and which ", world->reached[r].load(), " have reached");
    if (round_ < world->end_of_era(round_ - 1)) co_await phase();
  }
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(called_from_, round_, leaves_);
  }

 private:
  Task phase() {
    Random random(mix(world->seed ^ mix(static_cast<std::uint64_t>(index().x * most_rounds) +
                                        static_cast<std::uint64_t>(round_))));
    charge(std::chrono::microseconds(1 + index().x % 3));
    if (index().x < 60 && random.chance(world->create_chance)) {
      const int child = world->n_created++;
      ++world->n_alive;
      world->change(round_, 1);
      const PeId to = any_pe(random);
      const int next_era = world->end_of_era(round_);
      co_await epoch([&] { array()[{child}].insert_on(to, next_era); });
      array()[{child}].send<&Settler::run>(round_);
    }
    if (random.chance(world->destroy_chance)) {
      --world->n_alive;
      world->change(round_, -1);
      destroy();
      co_return;
    }
    ++world->reached[static_cast<std::size_t>(round_)];
    at_sync();
    if (!random.chance(world->leave_chance)) co_return;
    leaves_ = true;  // it ends while it waits
    --world->n_alive;
    if (round_ + 1 < world->end_of_era(round_)) world->change(round_ + 1, -1);
    destroy();
  }
  int called_from_ = 0, round_ = 0;
  bool leaves_ = false;
};

Task eras(int n_eras, int n_first, int n_new, BalanceOptions options) {
  const auto settlers = create<Settler>(sparse);
  start_balancing(settlers, options);
  for (int era = 0; era < n_eras; ++era) {
    const int round = era * world->n_phases;
    co_await epoch([&] {
      for (int k = era == 0 ? -n_first : 0; k < n_new; ++k) {
        const int x = world->n_created++;
        ++world->n_alive;
        settlers[{x}].insert_on(PeId{(x + era) % tess::n_pes()}, round);
      }
    });
    world->change(round, world->n_alive);
    co_await epoch([&] { settlers.broadcast<&Settler::begin>(round); });
  }
}

}  // namespace

void balance_newcomers(Trial& trial) {
  World here{trial};
  world = &here;
  here.seed = trial.seed();
  here.n_phases = trial.draw(1, most_phases);
  here.create_chance = 0.1 * trial.draw(0, 3);
  here.destroy_chance = 0.1 * trial.draw(0, 2);
  here.leave_chance = std::array{0.0, 0.0, 0.2, 1.0}[static_cast<std::size_t>(trial.draw(0, 3))];
  const int n_eras = trial.draw(1, most_eras), n_first = trial.draw(0, 10),
            n_new = trial.draw(0, 4);
  BalanceOptions options;
  const auto& names = balance::strategy_names();
  do options.strategy = names[trial.random().below(names.size())];
  while (options.strategy == "none");  // no barrier
  if (trial.draw(0, 3) == 0) options.when = BalanceWhen::automatic;
  trial.run_clean([&]() -> Task { return eras(n_eras, n_first, n_new, options); });
  for (int r = 0; r < n_eras * here.n_phases; ++r) {
    const auto round = static_cast<std::size_t>(r);
    trial.expect(here.reached[round] == here.lives_in[round], here.reached[round].load(), " of ",
                 here.lives_in[round].load(), " have reached round ", r);
  }
}

}  // namespace tess::fuzz
