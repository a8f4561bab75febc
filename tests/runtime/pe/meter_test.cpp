// The meter by itself: whose time it is, and that stolen time counts for none.
#include "runtime/pe/meter.hpp"

#include "runtime/core/cpu_clock.hpp"
#include "runtime/pe/measure/load_record.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <chrono>
#include <thread>
#include <utility>

namespace {

using namespace tess;
using namespace tess::detail;

/// Works for so long, whatever else runs on the core.
void work(double seconds) {
  const double end = thread_cpu_seconds() + seconds;
  while (thread_cpu_seconds() < end) {
  }
}

/// One simulated PE, whose clock goes on by charge() only.
std::unique_ptr<Machine> machine_without_costs() {
  SimulatedOptions options;
  options.n_pes = 1;
  options.cost = Time(0);
  return make_simulated_machine(options);
}

/// The record of an element that a balancer watches.
struct Balanced : LoadRecord {
  Balanced() { of_pe = &sum; }
  std::uint64_t sum = 0;
};

}  // namespace

TEST_CASE("time in which the thread did not run is taken back from the call that it fell in",
          "[runtime][meter]") {
  const auto machine = make_threads_machine(1);
  Meter meter(*machine, PeId{0});
  Balanced works, waits;
  meter.step_begins();
  {
    const Meter::Scope outer = meter.enter({&works, nullptr});
    work(2e-3);
    meter.leave(outer);
  }
  {
    const Meter::Scope outer = meter.enter({&waits, nullptr});
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // as when another program runs
    meter.leave(outer);
  }
  meter.step_ends();
  CHECK(meter.seconds(waits.ticks) < 10e-3);
  CHECK(meter.seconds(works.ticks) > 1e-3);
  CHECK(meter.seconds(meter.busy()) < 30e-3);
}

TEST_CASE("stolen time is taken back from each call of a long step, and from no other",
          "[runtime][meter]") {
  const auto machine = make_threads_machine(1);
  Meter meter(*machine, PeId{0});
  std::array<Balanced, 6> calls;  // a broadcast to them
  meter.step_begins();
  for (std::size_t i = 0; i < calls.size(); ++i) {
    const Meter::Scope outer = meter.enter({&calls[i], nullptr});
    work(3e-3);
    if (i % 2 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    meter.leave(outer);
  }
  meter.step_ends();
  for (const LoadRecord& call : calls) {
    CHECK(meter.seconds(call.ticks) > 2e-3);
    CHECK(meter.seconds(call.ticks) < 12e-3);
  }
  CHECK(meter.seconds(meter.busy()) > 12e-3);
  CHECK(meter.seconds(meter.busy()) < 60e-3);
}

TEST_CASE("time that was stolen outside of calls is no busy time, and taken back from no call",
          "[runtime][meter]") {
  const auto machine = make_threads_machine(1);
  Meter meter(*machine, PeId{0});
  Balanced works, is_brief;
  meter.step_begins();
  for (const auto& [record, seconds] : {std::pair(&works, 3e-3), std::pair(&is_brief, 4e-4)}) {
    const Meter::Scope outer = meter.enter({record, nullptr});
    work(seconds);
    meter.leave(outer);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the runtime is preempted
  meter.step_ends();
  CHECK(meter.seconds(works.ticks) > 2e-3);
  CHECK(meter.seconds(is_brief.ticks) > 2e-4);
  CHECK(meter.seconds(meter.busy()) > 2e-3);
  CHECK(meter.seconds(meter.busy()) < 30e-3);
}

TEST_CASE("the innermost scope has the time", "[runtime][meter]") {
  const auto machine = machine_without_costs();
  Meter meter(*machine, PeId{0});
  const auto pass = [&](int ns) { machine->charge(PeId{0}, Time(ns)); };
  Balanced outer_record;
  LoadRecord inner_record;  // no balancer watches it
  meter.step_begins();
  const Meter::Scope none = meter.enter({&outer_record, nullptr});
  pass(10);
  const Meter::Scope outer = meter.enter({&inner_record, nullptr});
  pass(200);
  meter.leave(outer);
  pass(3000);
  meter.leave(none);
  pass(40'000);
  meter.step_ends();
  CHECK(outer_record.ticks == 3010);
  CHECK(outer_record.in_run == 3010);
  CHECK(inner_record.ticks == 0);
  CHECK(inner_record.in_run == 200);
  CHECK(meter.in_records() == 3210);
  CHECK(meter.busy() == 43'210);
}

TEST_CASE("an alarm rings once per period, after a call with a record", "[runtime][meter]") {
  const auto machine = machine_without_costs();
  Meter meter(*machine, PeId{0});
  Balanced record;
  LoadRecord unwatched;
  int n_rings = 0;
  meter.add_alarm(1000, &n_rings, [&n_rings] { ++n_rings; });
  const auto call = [&](LoadRecord* of, int ns) {
    const Meter::Scope outer = meter.enter({of, nullptr});
    machine->charge(PeId{0}, Time(ns));
    meter.leave(outer);
  };
  call(&record, 999);
  CHECK(n_rings == 0);
  call(nullptr, 1);
  CHECK(n_rings == 0);  // it has no record
  call(&unwatched, 0);
  CHECK(n_rings == 0);
  call(&record, 1);
  CHECK(n_rings == 1);
  call(&record, 999);
  CHECK(n_rings == 1);
  call(&record, 5000);
  CHECK(n_rings == 2);
  meter.remove_alarms(&n_rings);
  call(&record, 5000);
  CHECK(n_rings == 2);
}
