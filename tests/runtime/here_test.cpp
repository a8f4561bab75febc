// What code on a PE can ask about this PE.
#include "runtime/more/room.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "tests/support/catch.hpp"

#include <chrono>
#include <vector>

namespace {

using std::chrono::microseconds;

class Probe : public tess::Group<Probe> {
 public:
  void nothing() {}
  void look(tess::Callback<std::vector<std::int64_t>> target) {
    contribute(tess::in_order(tess::concatenate),
               std::vector<std::int64_t>{tess::busy_time().count()}, std::move(target));
  }
  void work(int us) { (void)tess::charge(microseconds(us)); }
  void count(tess::Callback<std::size_t> target) {
    contribute(tess::sum, tess::n_collections(), std::move(target));
  }
  void fill(const std::vector<double>& /*values*/) {}
  void epoch_of(tess::Callback<std::vector<std::uint64_t>> target) {
    contribute(tess::in_order(tess::concatenate),
               std::vector<std::uint64_t>{tess::my_epoch().value}, std::move(target));
  }
};

template <class Main>
int run(const std::string& machine, std::uint64_t message_memory, Main main) {
  tess::Setup setup;
  setup.machine = tess::make_simulated_machine(tess::parse_simulated(machine));
  setup.options.messages.memory_bytes = message_memory;
  return tess::run(setup, main);
}

tess::Task work_and_look(tess::GroupProxy<Probe> probes, std::vector<std::int64_t>& spent) {
  tess::Future<std::vector<std::int64_t>> first, second;
  probes.broadcast<&Probe::look>(first.callback());
  const std::vector<std::int64_t> before = co_await first;
  co_await tess::epoch([&] {
    for (int i = 0; i < 3; ++i) probes[tess::PeId{1}].send<&Probe::work>(7);
    probes[tess::PeId{2}].send<&Probe::work>(40);
  });
  probes.broadcast<&Probe::look>(second.callback());
  const std::vector<std::int64_t> after = co_await second;
  for (std::size_t i = 0; i < before.size(); ++i) spent.push_back(after[i] - before[i]);
}

TEST_CASE("busy time is the time of a PE in messages, not the time that it waits", "[runtime]") {
  std::vector<std::int64_t> spent;
  CHECK(run("pes=3,latency=1ms,cost=100ns", 1U << 20U, [&]() -> tess::Task {
          return work_and_look(tess::create<Probe>(tess::each_pe), spent);
        }) == 0);
  // In virtual nanoseconds; the machine's cost per message is not counted.
  CHECK(spent == std::vector<std::int64_t>{0, 21'000, 40'000});
}

tess::Task create_and_count(std::vector<std::size_t>& counts) {
  const auto probes = tess::create<Probe>(tess::each_pe);
  const auto others = tess::create<Probe>(tess::each_pe);
  for (int round = 0; round < 2; ++round) {
    tess::Future<std::size_t> sum;
    co_await tess::epoch([&] { probes.broadcast<&Probe::count>(sum.callback()); });
    counts.push_back(co_await sum);
    co_await tess::epoch([&] { others.destroy(); });
    CHECK(others.local_or_null() == nullptr);
  }
}

TEST_CASE("each PE counts the arrays and groups that are not destroyed", "[runtime]") {
  std::vector<std::size_t> counts;
  CHECK(run("pes=4", 1U << 20U, [&]() -> tess::Task { return create_and_count(counts); }) == 0);
  CHECK(counts == std::vector<std::size_t>{8, 4});
}

tess::Task fill_up() {
  const auto probes = tess::create<Probe>(tess::each_pe);
  co_await tess::epoch([&] { probes.broadcast<&Probe::nothing>(); });
  const tess::PeId near{1}, far{2};  // of this process, of the other
  CHECK(tess::has_room(far));
  co_await tess::epoch([&] {
    for (const tess::PeId to : {near, far})
      probes[to].send<&Probe::fill>(std::vector<double>(1000));
    CHECK(tess::has_room(near));
    CHECK(!tess::has_room(far));
  });
  CHECK(tess::has_room(far));
}

TEST_CASE("there is room to a process until messages fill its memory, and again when they have run",
          "[runtime]") {
  CHECK(run("pes=4,per-process=2", 5000, []() -> tess::Task { return fill_up(); }) == 0);
}

tess::Task see_epochs(std::vector<tess::EpochId>& here, std::vector<std::uint64_t>& of_pes) {
  const auto probes = tess::create<Probe>(tess::each_pe);
  tess::Future<std::vector<std::uint64_t>> seen;
  here.push_back(tess::my_epoch());
  co_await tess::epoch([&] {
    here.push_back(tess::my_epoch());
    probes.broadcast<&Probe::epoch_of>(seen.callback());
  });
  here.push_back(tess::my_epoch());
  of_pes = co_await seen;
}

TEST_CASE("what an epoch causes is of this epoch, on every PE", "[runtime]") {
  std::vector<tess::EpochId> here;
  std::vector<std::uint64_t> of_pes;
  CHECK(run("pes=3", 1U << 20U, [&]() -> tess::Task { return see_epochs(here, of_pes); }) == 0);
  REQUIRE(here.size() == 3);
  CHECK(here[0] == tess::EpochId{});  // the run
  CHECK(here[1] != here[0]);
  CHECK(here[2] == here[0]);
  CHECK(of_pes == std::vector<std::uint64_t>(3, here[1].value));
}

}  // namespace
