// The clock of the simulated machine's measured cost, on a clockwork of our own: what it must count
// is known exactly, and no load of the machine changes it.
#include "runtime/wire/machine/work_clock.hpp"

#include "tests/support/catch.hpp"

namespace {

/// A thread whose clocks advance only when they are read or the test says so; two ticks are a
/// nanosecond.
struct Clockwork {
  std::uint64_t now = 1'000'000;  // ticks
  std::int64_t cpu = 0;           // nanoseconds
  std::uint64_t ticks_cost = 0;   // of a reading, in ticks
  std::uint64_t cpu_cost = 0;

  void work(std::int64_t nanoseconds) {
    now += 2 * static_cast<std::uint64_t>(nanoseconds);
    cpu += nanoseconds;
  }
  void sleep(std::int64_t nanoseconds) { now += 2 * static_cast<std::uint64_t>(nanoseconds); }
};

struct ClockworkTime {
  Clockwork* of;
  [[nodiscard]] std::uint64_t ticks() const {
    of->work(static_cast<std::int64_t>(of->ticks_cost / 2));
    return of->now;
  }
  [[nodiscard]] std::int64_t cpu_nanoseconds() const {
    of->work(static_cast<std::int64_t>(of->cpu_cost / 2));
    return of->cpu;
  }
  [[nodiscard]] static double nanoseconds_per_tick() { return 0.5; }
};
using Clock = tess::detail::WorkClock<ClockworkTime>;

}  // namespace

TEST_CASE("the cost of reading the clock is not work", "[runtime][machine][simulated]") {
  for (const std::uint64_t cost : {0U, 20U, 2000U}) {
    CAPTURE(cost);
    Clockwork thread;
    thread.ticks_cost = cost;
    thread.cpu_cost = 1600;
    Clock clock{ClockworkTime{&thread}};
    CHECK(clock.own_nanoseconds() == static_cast<double>(cost) / 2);
    clock.resume();
    for (int i = 0; i < 1000; ++i) CHECK(clock.read() == 0);
    std::int64_t worked = 0;
    for (int i = 0; i < 1000; ++i) {
      thread.work(i);
      worked += i;
      CHECK(clock.read() == worked);
    }
    clock.pause();
    CHECK(clock.read() == worked);
  }
}

TEST_CASE("what runs in a pause of the clock is not work", "[runtime][machine][simulated]") {
  Clockwork thread;
  thread.ticks_cost = 30;
  Clock clock{ClockworkTime{&thread}};
  for (std::int64_t i = 1; i <= 100; ++i) {
    clock.resume();
    thread.work(70);
    clock.pause();
    thread.work(50'000);
    CHECK(clock.read() == 70 * i);
  }
}

TEST_CASE("time that other threads took is not work", "[runtime][machine][simulated]") {
  Clockwork thread;
  thread.ticks_cost = 30;
  thread.cpu_cost = 1600;
  Clock clock{ClockworkTime{&thread}};
  clock.resume();
  thread.work(1000);
  thread.sleep(4'000'000);
  thread.work(1000);
  // A comparison of the two clocks counts a reading of one as time of the other.
  constexpr std::int64_t close = 2000;
  CHECK(std::abs(clock.read() - 2000) <= close);

  // A long interval without theft counts in full.
  const std::int64_t before = clock.read();
  thread.work(7'000'000);
  CHECK(clock.read() == before + 7'000'000);

  // What was taken in a pause is not charged to the work that follows.
  clock.pause();
  thread.sleep(9'000'000);
  clock.resume();
  const std::int64_t after = clock.read();
  thread.work(500'000);
  CHECK(clock.read() == after + 500'000);
}

TEST_CASE("the clock of this thread never runs backwards, and stands still in a pause",
          "[runtime][machine][simulated]") {
  tess::detail::WorkClock<> clock;
  CHECK(clock.read() == 0);
  clock.resume();
  std::int64_t last = 0;
  for (int i = 0; i < 10'000; ++i) {
    const std::int64_t now = clock.read();
    CHECK(now >= last);
    last = now;
  }
  clock.pause();
  const std::int64_t paused = clock.read();
  for (int i = 0; i < 1000; ++i) CHECK(clock.read() == paused);
}
