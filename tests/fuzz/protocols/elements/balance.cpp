// Balance rounds while elements are created, end, migrate, contribute, and wait at the barrier. The
// oracles: every wait is resumed exactly once, every phase of every life is run, and every
// contribution arrives; with `rotate` elements are where the rounds have put them; periodic rounds
// lose no message.
#include "runtime/balance.hpp"

#include "runtime/balance/strategy.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <array>
#include <map>

namespace tess::fuzz {
namespace {

struct Lives {
  std::uint64_t seed = 0;
  double create_chance = 0, move_chance = 0;
  std::map<std::pair<int, int>, int> phases_run{};
  std::int64_t n_contributed = 0, n_collected = 0;

  [[nodiscard]] Random draws(int root, int path, int phase) const {
    return Random(mix(seed ^ mix(static_cast<std::uint64_t>(root) * 1000003U +
                                 static_cast<std::uint64_t>(path) * 16U +
                                 static_cast<std::uint64_t>(phase))));
  }
  [[nodiscard]] int n_phases(int root, int path) const {
    return 1 + static_cast<int>(draws(root, path, 15).below(6));
  }
  [[nodiscard]] bool creates(int root, int path, int phase) const {
    return path < 100 && draws(root, path, phase).chance(create_chance);
  }
  /// What one life and all its descendants run, in phases.
  void expect_life(std::map<std::pair<int, int>, int>& expected, int root, int path) const {
    const int n = n_phases(root, path);
    expected[{root, path}] = n;
    for (int phase = 0; phase < n; ++phase)
      if (creates(root, path, phase)) expect_life(expected, root, path * 10 + phase + 1);
  }
};
Lives* lives_of_case = nullptr;

class Life : public Chare<Life, Index2> {
 public:
  void begin(int round) {
    round_ = round;
    live();
  }
  void resume_from_sync() {
    expect(waiting_, "resumed without waiting: ", element_text(*this));
    waiting_ = false;
    live();
  }
  [[nodiscard]] std::array<double, 3> balance_position() const {
    return {1.0 * index().x, 1.0 * index().y, 0};
  }
  void serialize(auto& ar) { ar(phase_, round_, waiting_); }

 private:
  void live();
  int phase_ = 0;
  int round_ = 0;  // of its next contribution
  bool waiting_ = false;
};

class Collector : public Group<Collector> {
 public:
  void collected(std::int64_t n) {
    locked([&] { lives_of_case->n_collected += n; });
  }
};
GroupProxy<Collector> collector_of_case;

void Life::live() {
  Lives& l = *lives_of_case;
  const int root = index().x;
  const int path = index().y;
  const int phase = phase_++;
  {
    const std::lock_guard lock(oracle);
    ++l.phases_run[{root, path}];
    ++l.n_contributed;
  }
  charge(std::chrono::microseconds(1 + root % 5));
  const RoundId round{round_++};
  if (l.creates(root, path, phase)) {
    const auto child = array()[{root, path * 10 + phase + 1}];
    child.insert(round);
    child.send<&Life::begin>(round_ - 1);
  }
  contribute(round, sum, std::int64_t{1},
             collector_of_case[PeId{0}].target<&Collector::collected>());
  Random random = l.draws(root, path, phase + 100);
  if (random.chance(l.move_chance)) migrate_to(any_pe(random));
  if (phase_ == l.n_phases(root, path)) {
    destroy();
    return;
  }
  waiting_ = true;
  at_sync();
}

/// Checks the place of each element under `rotate` after so many rounds.
class Rotor : public Chare<Rotor, Index1> {
 public:
  static inline int n_rounds = 0;
  static inline std::atomic<int> n_done{0};

  void begin() { at_sync(); }
  void resume_from_sync() {
    // In the first round elements stay that ran before they were measured.
    if (round_ == 0) first_ = tess::my_pe().value - 1;
    ++round_;
    const int n_pes = tess::n_pes();
    const int expected = (first_ + round_ + n_pes) % n_pes;
    expect(tess::my_pe().value == expected, element_text(*this), " is on ", tess::my_pe(),
           " after round ", round_, ", not on PE ", expected);
    if (round_ < n_rounds) {
      at_sync();
    } else {
      ++n_done;
    }
  }
  void serialize(auto& ar) { ar(first_, round_); }

 private:
  int first_ = 0, round_ = 0;
};

/// Does a phase's work in a few messages to itself, of a cost that its index gives.
class PhasedWorker : public Chare<PhasedWorker, Index1> {
 public:
  static inline int n_parts = 0, n_phases = 0, every_leaves = 0;  // 0: none leaves

  static std::int64_t nanoseconds_of_part(std::int32_t x) { return 20'000 * (1 + x % 4); }

  void part(int done) {
    charge(std::chrono::nanoseconds(nanoseconds_of_part(index().x)));
    if (done + 1 < n_parts) {
      array()[index()].send<&PhasedWorker::part>(done + 1);
    } else if (phase_ == 0 && every_leaves != 0 && index().x % every_leaves == 0) {
      destroy();  // perhaps where balancing has not started, after it began elsewhere
    } else {
      at_sync();
    }
  }
  void resume_from_sync() {
    if (++phase_ < n_phases) part(0);
  }
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  void serialize(auto& ar) { ar(phase_); }

 private:
  int phase_ = 0;
};

/// Compares every known load in a strategy's snapshot with the work of the phase, and checks that
/// only elements of known load move.
class LoadsShown {
 public:
  LoadsShown(std::string strategy, bool exactly)
      : name_(std::move(strategy)), run_(balance::make_strategy(name_, 1)), exactly_(exactly) {}

  balance::Assignment operator()(const balance::Snapshot& s) {
    const balance::Assignment to = run_(s);
    for (std::size_t i = 0; i < s.elements.size(); ++i) {
      if (!s.elements.load[i].is_known()) {
        expect(to[i] == s.elements.pe[i], name_, " moves an element of unknown load");
        continue;
      }
      const auto x = static_cast<std::int32_t>(x_of_.at(s.elements.key[i].element));
      const double phase = 1e-9 * static_cast<double>(PhasedWorker::nanoseconds_of_part(x)) *
                           static_cast<double>(PhasedWorker::n_parts);
      const double load = s.elements.load[i].seconds();
      expect(load >= 0.99 * phase && (!exactly_ || load <= 1.1 * phase), "round ", n_rounds_,
             ": the load of PhasedWorker[", x, "] is shown as ", load, " s, it did ", phase);
    }
    ++n_rounds_;
    return to;
  }
  void know(std::int32_t x) { x_of_[IndexHash<Index1>()(Index1{x})] = x; }

 private:
  std::string name_;
  balance::Strategy run_;
  bool exactly_;
  int n_rounds_ = 0;
  std::map<std::uint64_t, std::int32_t> x_of_;
};

/// Sends itself around a ring of elements, while periodic rounds move them.
class Runner : public Chare<Runner, Index1> {
 public:
  static inline std::atomic<std::int64_t> n_hops{0};

  void hop(int left) {
    ++n_hops;
    charge(std::chrono::microseconds(1 + index().x % 7));
    if (left > 0)
      array()[{(index().x * 5 + left) % static_cast<int>(array().size())}].send<&Runner::hop>(left -
                                                                                              1);
  }
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  void serialize(auto& /*ar*/) {}
};

}  // namespace

void balance_rounds(Case& test) {
  Lives l{};
  lives_of_case = &l;
  l.seed = test.seed;
  l.create_chance = 0.1 * test.draw(0, 3);
  l.move_chance = 0.1 * test.draw(0, 3);
  const int n = test.draw(0, 24);
  BalanceOptions options;
  options.strategy = any_of(balance::strategy_names(), test.random);
  if (test.draw(0, 3) == 0) options.when = BalanceWhen::automatic;
  const bool late = test.draw(0, 3) == 0;  // balancing starts when some already wait
  test.run_clean([&] {
    collector_of_case = create<Collector>(each_pe);
    const auto lives = create<Life>(sparse);
    if (!late) start_balancing(lives, options);
    for (int i = 0; i < n; ++i) lives[{i, 1}].insert_on(PeId{i % tess::n_pes()}, RoundId{0});
    for (int i = 0; i < n; ++i) lives[{i, 1}].send<&Life::begin>(0);
    if (late) start_balancing(lives, options);
  });
  std::map<std::pair<int, int>, int> expected;
  for (int i = 0; i < n; ++i) l.expect_life(expected, i, 1);
  expect(l.phases_run == expected, l.phases_run.size(), " lives ran, ", expected.size(),
         " were to, or in other phases; strategy ", options.strategy);
  expect(l.n_collected == l.n_contributed, l.n_contributed, " contributions were made, ",
         l.n_collected, " arrived");
}

void balance_rotate(Case& test) {
  Rotor::n_rounds = 40;
  Rotor::n_done = 0;
  test.machine.migration = 0;
  constexpr int n = 8;
  test.run_clean([] {
    const auto rotors = create<Rotor>(range(n));
    start_balancing(rotors, {.strategy = "rotate"});
    rotors.broadcast<&Rotor::begin>();
  });
  expect(Rotor::n_done == n, Rotor::n_done.load(), " of ", n, " elements met all rounds");
}

void balance_first_round(Case& test) {
  const int n = test.draw(1, 40);
  PhasedWorker::n_parts = test.draw(1, 3);
  PhasedWorker::n_phases = test.draw(1, 3);
  // A message that is under way while loads are collected brings two phases to the next collection.
  const bool moves = test.draw(0, 1) == 0;
  if (!moves) test.machine.migration = 0;
  const bool by_broadcast = test.draw(0, 1) == 0;
  PhasedWorker::every_leaves = test.draw(0, 3);
  LoadsShown shown(any_of(balance::strategy_names(), test.random), !moves);
  for (std::int32_t x = 0; x < n; ++x) shown.know(x);
  test.run_clean([&] {
    const auto workers = create<PhasedWorker>(range(n));
    start_balancing(workers, {}, [&](const balance::Snapshot& s) { return shown(s); });
    if (by_broadcast) {
      workers.broadcast<&PhasedWorker::part>(0);
    } else {
      for (std::int32_t x = 0; x < n; ++x) workers[{x}].send<&PhasedWorker::part>(0);
    }
  });
}

void balance_periodic(Case& test) {
  Runner::n_hops = 0;
  const int n = test.draw(1, 20), n_runs = test.draw(1, 10), n_hops = test.draw(1, 200);
  BalanceOptions options;
  options.strategy = any_of(balance::strategy_names(), test.random);
  options.when = BalanceWhen::periodic;
  options.period = std::chrono::microseconds(test.draw(5, 500));
  test.run_clean([&] {
    const auto runners = create<Runner>(range(n));
    start_balancing(runners, options);
    for (int i = 0; i < n_runs; ++i) runners[{i % n}].send<&Runner::hop>(n_hops);
  });
  expect(Runner::n_hops == std::int64_t{n_runs} * (n_hops + 1), Runner::n_hops.load(), " hops of ",
         n_runs * (n_hops + 1));
}

}  // namespace tess::fuzz
