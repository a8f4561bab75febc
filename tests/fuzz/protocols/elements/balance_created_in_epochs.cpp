// The balancer's barrier, for elements that are created in awaited epochs: between phases by the
// main task, and within a phase by elements before they call at_sync(). The oracle: a round ends
// once exactly the elements that live in it have reached it.
#include "runtime/balance.hpp"
#include "runtime/balance/strategy.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <array>
#include <atomic>

namespace tess::fuzz {
namespace {

constexpr int most_stages = 6, most_phases = 3, most_rounds = most_stages * most_phases;

struct LateExpected {
  std::uint64_t seed = 0;
  int n_phases = 1;  // of an stage
  double create_chance = 0, destroy_chance = 0, leave_chance = 0;
  std::atomic<int> n_created{0}, n_alive{0};
  std::array<std::atomic<int>, most_rounds> lives_in{}, reached{};

  /// So many live in `round` and in the rounds of its stage after it, more than before.
  void change(int round, int by) {
    for (int r = round; r < end_of_stage(round); ++r) lives_in[static_cast<std::size_t>(r)] += by;
  }
  [[nodiscard]] int end_of_stage(int round) const { return (round / n_phases + 1) * n_phases; }
};
LateExpected* late_expected = nullptr;

class LateElement : public Chare<LateElement, Index1> {
 public:
  LateElement() = default;
  explicit LateElement(int called_from) : called_from_(called_from) {}

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
    expect(late_expected->reached[r] == late_expected->lives_in[r], element_text(*this),
           " is past round ", r, ", in which ", late_expected->lives_in[r].load(),
           " live, and which ", late_expected->reached[r].load(), " have reached");
    if (round_ < late_expected->end_of_stage(round_ - 1)) co_await phase();
  }
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  void serialize(auto& ar) { ar(called_from_, round_, leaves_); }

 private:
  Task phase() {
    Random random(
        mix(late_expected->seed ^ mix(static_cast<std::uint64_t>(index().x * most_rounds) +
                                      static_cast<std::uint64_t>(round_))));
    charge(std::chrono::microseconds(1 + index().x % 3));
    if (index().x < 60 && random.chance(late_expected->create_chance)) {
      const int child = late_expected->n_created++;
      ++late_expected->n_alive;
      late_expected->change(round_, 1);
      const PeId to = any_pe(random);
      const int next_stage = late_expected->end_of_stage(round_);
      co_await epoch([&] { array()[{child}].insert_on(to, next_stage); });
      array()[{child}].send<&LateElement::run>(round_);
    }
    if (random.chance(late_expected->destroy_chance)) {
      --late_expected->n_alive;
      late_expected->change(round_, -1);
      destroy();
      co_return;
    }
    ++late_expected->reached[static_cast<std::size_t>(round_)];
    at_sync();
    if (!random.chance(late_expected->leave_chance)) co_return;
    leaves_ = true;  // it ends while it waits
    --late_expected->n_alive;
    if (round_ + 1 < late_expected->end_of_stage(round_)) late_expected->change(round_ + 1, -1);
    destroy();
  }
  int called_from_ = 0, round_ = 0;
  bool leaves_ = false;
};

Task stages(int n_stages, int n_first, int n_new, BalanceOptions options) {
  const auto elements = create<LateElement>(sparse);
  start_balancing(elements, options);
  for (int stage = 0; stage < n_stages; ++stage) {
    const int round = stage * late_expected->n_phases;
    co_await epoch([&] {
      for (int k = stage == 0 ? -n_first : 0; k < n_new; ++k) {
        const int x = late_expected->n_created++;
        ++late_expected->n_alive;
        elements[{x}].insert_on(PeId{(x + stage) % tess::n_pes()}, round);
      }
    });
    late_expected->change(round, late_expected->n_alive);
    co_await epoch([&] { elements.broadcast<&LateElement::begin>(round); });
  }
}

}  // namespace

void balance_created_in_epochs(Case& test) {
  LateExpected here{};
  late_expected = &here;
  here.seed = test.seed;
  here.n_phases = test.draw(1, most_phases);
  here.create_chance = 0.1 * test.draw(0, 3);
  here.destroy_chance = 0.1 * test.draw(0, 2);
  here.leave_chance = std::array{0.0, 0.0, 0.2, 1.0}[static_cast<std::size_t>(test.draw(0, 3))];
  const int n_stages = test.draw(1, most_stages), n_first = test.draw(0, 10),
            n_new = test.draw(0, 4);
  BalanceOptions options;
  do options.strategy = any_of(balance::strategy_names(), test.random);
  while (options.strategy == "none");  // no barrier
  if (test.draw(0, 3) == 0) options.when = BalanceWhen::automatic;
  test.run_clean([&]() -> Task { return stages(n_stages, n_first, n_new, options); });
  for (int r = 0; r < n_stages * here.n_phases; ++r) {
    const auto round = static_cast<std::size_t>(r);
    expect(here.reached[round] == here.lives_in[round], here.reached[round].load(), " of ",
           here.lives_in[round].load(), " have reached round ", r);
  }
}

}  // namespace tess::fuzz
