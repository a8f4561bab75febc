// Timers: exactly, in the virtual time of the simulated machine, and on threads.
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <atomic>
#include <csignal>

namespace {

using namespace std::chrono_literals;

template <class Main>
tests::Ending simulate(Main main, std::int32_t n_pes = 4) {
  return tests::run(tess::text("pes=", n_pes, ",cost=0ns"), std::move(main));
}
template <class Main>
tests::Ending on_threads(Main main, std::int32_t n_pes = 2) {
  return tests::run_threads(n_pes, std::move(main));
}

/// The test framework handles signals itself; in this scope the system does.
class DefaultAction {
 public:
  explicit DefaultAction(int signal) : signal_(signal), before_(std::signal(signal, SIG_DFL)) {}
  DefaultAction(const DefaultAction&) = delete;
  DefaultAction& operator=(const DefaultAction&) = delete;
  ~DefaultAction() { std::signal(signal_, before_); }

 private:
  int signal_;
  void (*before_)(int);
};

class Sink : public tess::Chare<Sink, tess::Index1> {
 public:
  void take(tess::Callback<std::int64_t> to) { to(tess::current_pe().now().count()); }
};

/// Has a periodic timer that ends with its first call, which sends a message around the PEs.
class LastTick : public tess::Group<LastTick> {
 public:
  static inline int n_sent = 0, n_arrived = 0;
  static inline int n_ticks = 0, n_ticks_in_the_middle = 0;

  void begin(std::int64_t period_ns, int n_hops) {
    const auto timer = std::make_shared<tess::Timer>();
    *timer = tess::every(std::chrono::nanoseconds(period_ns), [group = group(), timer, n_hops] {
      group.local().send(n_hops);
      timer->cancel();
    });
  }
  void send(int n_more) const {
    ++n_sent;
    group()[tess::PeId{(pe().value + 1) % tess::n_pes()}].send<&LastTick::arrive>(n_more);
  }
  void arrive(int n_more) {
    ++n_arrived;
    if (n_more == 20) n_ticks_in_the_middle = n_ticks;
    if (n_more > 0) send(n_more - 1);
  }
  void tick() const {
    (void)tess::every(500ns, [] { ++n_ticks; });
  }
};

}  // namespace

TEST_CASE("a timer on the simulated machine runs at its virtual time", "[runtime][timers]") {
  std::vector<std::int64_t> times;
  const tests::Ending ending = simulate([&] {
    for (const auto delay : {5ms, 2ms, 0ms, 3ms})
      tess::after(delay, [&] { times.push_back(tess::current_pe().now().count()); });
  });
  CHECK(ending.exit_code == 0);
  CHECK(times == std::vector<std::int64_t>{0, 2'000'000, 3'000'000, 5'000'000});
}

TEST_CASE("a timer is exact in any order of messages", "[runtime][timers]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<tess::Time> times;
    tests::run(tess::text("pes=3,cost=0ns,seed=", seed), [&times]() -> tess::Task {
      const tess::Time begin = tess::now();
      for (const auto delay : {5ms, 1ms})
        tess::after(delay, [&times, begin] { times.push_back(tess::now() - begin); });
      co_await tess::sleep(7ms);
      times.push_back(tess::now() - begin);
    });
    CHECK(times == std::vector<tess::Time>{1ms, 5ms, 7ms});
  }
}

TEST_CASE("a target gets its value after the delay", "[runtime][timers]") {
  std::int64_t at = 0;
  const tests::Ending ending = simulate([&]() -> tess::Task {
    const auto sinks = tess::create<Sink>(tess::range(4));
    tess::Future<std::int64_t> result;
    tess::after(7ms, sinks[{0}].target<&Sink::take>(), result.callback());
    at = co_await result;
  });
  CHECK(ending.exit_code == 0);
  CHECK(at >= 7'000'000);
}

TEST_CASE("an epoch and the run wait for a timer", "[runtime][timers][threads]") {
  for (const bool threads : {false, true}) {
    bool in_epoch = false, in_run = false, was_done = false;
    const auto main = [&]() -> tess::Task {
      co_await tess::epoch([&] { tess::after(20ms, [&] { in_epoch = true; }); });
      was_done = in_epoch;
      tess::after(20ms, [&] { in_run = true; });
    };
    const tests::Ending ending = threads ? on_threads(main) : simulate(main);
    CHECK(ending.exit_code == 0);
    CHECK(was_done);
    CHECK(in_run);
  }
}

TEST_CASE("a periodic timer ticks at multiples of its period until it is cancelled",
          "[runtime][timers]") {
  std::vector<std::int64_t> times;
  const tests::Ending ending = simulate([&] {
    const auto timer = std::make_shared<tess::Timer>();
    *timer = tess::every(1ms, [&times, timer] {
      times.push_back(tess::current_pe().now().count());
      tess::charge(times.size() == 2 ? 2500us : 0us);  // the third and fourth are missed
      if (times.size() == 4) timer->cancel();
    });
    tess::after(20ms, [] {});
  });
  CHECK(ending.exit_code == 0);
  CHECK(times == std::vector<std::int64_t>{1'000'000, 2'000'000, 5'000'000, 6'000'000});
}

TEST_CASE("a run ends, or reports its deadlock, beside a periodic timer",
          "[runtime][timers][threads]") {
  for (const bool threads : {false, true}) {
    const auto done = [] { (void)tess::every(1ms, [] {}); };
    CHECK((threads ? on_threads(done) : simulate(done)).exit_code == 0);
    const auto waits = []() -> tess::Task {
      (void)tess::every(1ms, [] {});
      tess::Future<int> never;
      co_await never;
    };
    const tests::Ending ending = threads ? on_threads(waits) : simulate(waits);
    CHECK(ending.exit_code == 1);
    CHECK(ending.report.find("the main program on PE 0: ") != std::string::npos);
    CHECK(ending.report.find(" waits for a future of int") != std::string::npos);
  }
}

TEST_CASE("the run does not end before what the last call of a periodic timer sends",
          "[runtime][timers]") {
  LastTick::n_sent = LastTick::n_arrived = 0;
  int n_ticked = 0, n_runs = 0;
  // Some of the calls come after PE 0 has found that nothing is under way, and before it ends the
  // run.
  for (std::int64_t period_ns = 1000; period_ns < 60'000; period_ns += 100, ++n_runs) {
    const tests::Ending ending = simulate([&] {
      tess::create<LastTick>(tess::each_pe)[tess::PeId{3}].send<&LastTick::begin>(period_ns, 8);
    });
    CHECK(ending.exit_code == 0);
    INFO("a period of " << period_ns << " ns");
    REQUIRE(LastTick::n_arrived == LastTick::n_sent);
    n_ticked = LastTick::n_sent;
  }
  CHECK(n_ticked > 0);
  CHECK(n_ticked < n_runs);  // the longer periods end after the run
}

TEST_CASE("periodic timers go on if the run that seemed to end does not", "[runtime][timers]") {
  int n_runs = 0;
  for (std::int64_t period_ns = 1000; period_ns < 10'000; period_ns += 100) {
    LastTick::n_sent = LastTick::n_ticks = LastTick::n_ticks_in_the_middle = 0;
    const tests::Ending ending = simulate([&] {
      const auto member = tess::create<LastTick>(tess::each_pe)[tess::PeId{3}];
      member.send<&LastTick::begin>(period_ns, 40);
      member.send<&LastTick::tick>();
    });
    CHECK(ending.exit_code == 0);
    if (LastTick::n_sent == 0) continue;
    ++n_runs;
    INFO("a period of " << period_ns << " ns");
    REQUIRE(LastTick::n_ticks >= LastTick::n_ticks_in_the_middle + 30);  // 20 hops of 1 us
  }
  CHECK(n_runs > 0);
}

TEST_CASE("an epoch ends although a periodic timer was made in it", "[runtime][timers]") {
  bool ended = false;
  const tests::Ending ending = simulate([&]() -> tess::Task {
    co_await tess::epoch([] { (void)tess::every(1us, [] {}); });
    ended = true;
  });
  CHECK(ending.exit_code == 0);
  CHECK(ended);
}

TEST_CASE("thousands of timers on threads run once each, none too early",
          "[runtime][timers][threads]") {
  std::atomic<int> n_run{0}, n_early{0};
  constexpr int n_timers = 5000;
  const tests::Ending ending = on_threads([&] {
    tess::Random random(7);
    for (int i = 0; i < n_timers; ++i) {
      const tess::Time delay(static_cast<std::int64_t>(random.below(50'000'000)));
      const tess::Time due = tess::current_pe().now() + delay;
      tess::after(delay, [&n_run, &n_early, due] {
        ++n_run;
        if (tess::current_pe().now() < due) ++n_early;
      });
    }
  });
  CHECK(ending.exit_code == 0);
  CHECK(n_run == n_timers);
  CHECK(n_early == 0);
}

TEST_CASE("exit ends a run whose timers have not run", "[runtime][timers][threads]") {
  for (const bool threads : {false, true}) {
    const auto main = [] {
      for (int i = 0; i < 10; ++i) tess::after(std::chrono::hours(1), [] { std::abort(); });
      (void)tess::every(10us, [] {});
      tess::after(5ms, [] { tess::exit(3); });
    };
    CHECK((threads ? on_threads(main) : simulate(main)).exit_code == 3);
  }
}

TEST_CASE("a signal ends a run with its number and a census", "[runtime][signals][threads]") {
  const DefaultAction action(SIGTERM);
  const tests::Ending ending = on_threads([]() -> tess::Task {
    tess::after(5ms, [] { ::raise(SIGTERM); });
    tess::after(std::chrono::hours(1), [] {});  // otherwise it may be reported as a deadlock first
    tess::Future<int> never;
    co_await never;
  });
  CHECK(ending.exit_code == 128 + SIGTERM);
  CHECK(ending.report.find("SIGTERM ends the run; 2 wait:\n  the main program on PE 0: ") !=
        std::string::npos);
  CHECK(ending.report.find("\n  PE 0: 1 timer is set\n") != std::string::npos);
  struct sigaction now {};
  ::sigaction(SIGTERM, nullptr, &now);
  CHECK(now.sa_handler == SIG_DFL);
}

TEST_CASE("a signal during a simulated run gets its census", "[runtime][signals]") {
  const DefaultAction action(SIGINT);
  const tests::Ending ending = simulate([] {
    (void)tess::every(1ms, [] {});
    const auto again = std::make_shared<std::function<void()>>();
    *again = [weak = std::weak_ptr(again)] { tess::after(1us, *weak.lock()); };
    tess::after(1us, [again] { (*again)(); });
    (void)tess::every(1s, [again] {});
    tess::after(1ms, [] { ::raise(SIGINT); });
  });
  CHECK(ending.exit_code == 128 + SIGINT);
  CHECK(ending.report.find("SIGINT ends the run; 1 wait:\n  PE 0: ") != std::string::npos);
}

TEST_CASE("a request for a report between two runs does not end the program",
          "[runtime][signals][threads]") {
  const DefaultAction action(SIGUSR1);
  for (int i = 0; i < 2; ++i) {
    CHECK(on_threads([] {}).exit_code == 0);
    CHECK(::raise(SIGUSR1) == 0);
  }
}
