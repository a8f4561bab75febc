// Timers of elements that migrate, nested and inside epochs, and periodic timers that are cancelled
// on their PE, cancelled from another PE, or never cancelled. The oracle is the elements' own
// record: every timer that was set has run once when the epoch returns, none too early, and the
// messages of periodic timers have all arrived when the run has ended.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <array>
#include <atomic>

namespace tess::fuzz {
namespace {

struct TimerRecord {
  int n_elements = 0;
  std::uint64_t longest = 0;  // ns of a delay
  double move_chance = 0;
  int n_rounds = 0;
  std::atomic<std::int64_t> n_tick_messages{0}, n_tick_arrivals{0};
};
TimerRecord* timer_record = nullptr;

/// A tree of timers: each one that runs may set others.
struct TimerTree {
  std::uint64_t id = 0;
  int energy = 0;
};

class TimerElement : public Chare<TimerElement, Index1> {
 public:
  void start_tree(TimerTree tree) {
    Random random(mix(tree.id ^ static_cast<std::uint64_t>(index().x)));
    set(tree.energy, random);
  }
  /// A timer has run.
  void ran(TimerTree tree) {
    record_[1] += 1;
    record_[3] += tree.id >> 8U;
    Random random(mix(tree.id));
    if (tree.energy > 0) set(tree.energy - 1, random);
    if (random.chance(timer_record->move_chance)) migrate_to(any_pe(random));
  }
  void report(Callback<std::array<std::uint64_t, 4>> target) {
    contribute(sum, record_, std::move(target));
  }
  void serialize(auto& ar) { ar(record_); }

 private:
  void set(int energy, Random& random) {
    for (int n = 1 + draw(random, 2); n > 0; --n) {
      const TimerTree tree{random(), energy};
      record_[0] += 1;
      record_[2] += tree.id >> 8U;
      const Time delay = any_time(random, timer_record->longest);
      const auto to = array()[{draw(random, timer_record->n_elements)}];
      if (random.chance(0.5)) {
        after(delay, to.target<&TimerElement::ran>(), tree);
        continue;
      }
      const PeId pe = my_pe();
      const Time due = now() + delay;
      after(delay, [to, tree, pe, due] {
        expect(my_pe() == pe, "a timer of ", pe, " runs on ", my_pe());
        expect(now() >= due, "a timer runs ", (due - now()).count(), " ns too early");
        to.send<&TimerElement::ran>(tree);
      });
    }
  }

  std::array<std::uint64_t, 4> record_{};  // set, run, and the sums of their ids
};

class Ticker : public Group<Ticker> {
 public:
  void begin(std::uint64_t seed) {
    Random random(mix(seed ^ static_cast<std::uint64_t>(pe().value)));
    for (int n = draw(random, 4); n > 0; --n) start(random);
  }
  void tick(int n_more) {
    ++timer_record->n_tick_arrivals;
    if (n_more == 0) return;
    ++timer_record->n_tick_messages;
    group()[pe()].send<&Ticker::tick>(n_more - 1);
  }
  void stop(Timer timer) const { timer.cancel(); }

 private:
  struct State {
    Timer timer;
    bool cancelled = false;
    int n_ticks = 0;
  };
  void start(Random& random) {
    // A timer of nanoseconds never lets its core go, which other ranks may share; in virtual time a
    // message of a slow kind takes a tenth of a second.
    const std::int64_t least = machine().virtual_time() ? 20'000 : 200'000;
    const Time period(least + static_cast<std::int64_t>(random.below(timer_record->longest)));
    const auto n_pes = static_cast<std::uint64_t>(tess::n_pes());
    const PeId to{static_cast<std::int32_t>(random.below(n_pes))};
    const auto kind = draw(random, 3);
    const int n_last = 1 + draw(random, 5);
    auto state = std::make_shared<State>();
    state->timer = every(period, [group = group(), to, kind, n_last, state] {
      expect(!state->cancelled, "a timer runs after it was cancelled");
      const int n = ++state->n_ticks;
      // Those that are never cancelled come to send nothing, so that the run becomes quiescent.
      if (n > 2 * n_last) return;
      ++timer_record->n_tick_messages;
      group[to].send<&Ticker::tick>(n % 3);
      if (n != n_last || kind == 0) return;
      if (kind == 1) {
        state->timer.cancel();
        state->cancelled = true;
      } else {
        group[to].send<&Ticker::stop>(state->timer);
      }
    });
  }
};

Task run_timers(std::uint64_t seed) {
  const auto elements = tess::create<TimerElement>(range(timer_record->n_elements));
  const auto tickers = create<Ticker>(each_pe);
  for (int round = 0; round < timer_record->n_rounds; ++round) {
    const std::uint64_t of_round = mix(seed + static_cast<std::uint64_t>(round));
    co_await epoch([&] {
      if (round == 0) tickers.broadcast<&Ticker::begin>(of_round);
      elements.broadcast<&TimerElement::start_tree>(
          TimerTree{of_round, static_cast<int>(of_round % 4)});
    });
    const auto [n_set, n_run, set, run] = co_await elements.reduce<&TimerElement::report>();
    expect(n_set == n_run, n_set, " timers were set, ", n_run, " have run");
    expect(set == run, "other timers have run than were set");
  }
}

}  // namespace

void timers(Case& test) {
  TimerRecord here{test.draw(1, 12), 100ULL << test.draw(0, 12), 0.3 * test.draw(0, 2),
                   test.draw(1, 4)};
  timer_record = &here;
  const std::uint64_t seed = test.random();
  test.run_clean([&]() -> Task { return run_timers(seed); });
  if (test.on == On::job) return;  // the messages of one process arrive in another
  expect(here.n_tick_messages == here.n_tick_arrivals, here.n_tick_messages.load(),
         " messages of periodic timers were sent, ", here.n_tick_arrivals.load(), " have arrived");
}

}  // namespace tess::fuzz
