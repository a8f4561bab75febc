// What a run made is known as made in the run that goes on with its checkpoint, and in the one
// after that.
#include "runtime/checkpoint.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/singleton.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/support/scratch.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <vector>

namespace {

using namespace std::chrono_literals;
using tess::test::completes;

class Leaf : public tess::Chare<Leaf> {
 public:
  void count(const tess::Callback<int>& target) { contribute(tess::sum, 1, target); }
  void serialize(auto& /*ar*/) {}
};

/// It makes arrays and sections of its array, and keeps them.
class Maker : public tess::Chare<Maker> {
 public:
  void make(int a, int b) {
    const std::vector<tess::Index1> members{{a}, {b}};
    sections_.push_back(tess::create_section(array(), members));
    leaves_.push_back(tess::create<Leaf>(tess::range(3)));
  }
  void make_and_end() { tess::create<Leaf>(tess::range(3)).destroy(); }
  void call(std::size_t section, int x) { sections_.at(section).broadcast<&Maker::hit>(x); }
  void hit(int x) { hits_ += x; }
  void report(const tess::Callback<std::vector<int>>& target) {
    contribute(tess::in_order(tess::concatenate), std::vector<int>{hits_}, target);
  }
  void count(std::size_t array, const tess::Callback<int>& target) {
    leaves_.at(array).broadcast<&Leaf::count>(target);
  }
  void serialize(auto& ar) { ar(sections_, leaves_, hits_); }

 private:
  std::vector<tess::SectionProxy<Maker>> sections_;
  std::vector<tess::ArrayProxy<Leaf>> leaves_;
  int hits_ = 0;
};

struct State {
  tess::ArrayProxy<Maker> makers;
  tess::Timer timer;
};
constexpr int n = 8;

tess::Task begin(std::string folder) {
  State state;
  state.makers = tess::create<Maker>(tess::range(n));
  co_await tess::epoch([&] {
    for (int i = 0; i < n; ++i) {
      state.makers[{i}].send<&Maker::make>(i, (i + 1) % n);
      state.makers[{i}].send<&Maker::make_and_end>();
    }
    state.timer = tess::after(1us, [] {});
  });
  co_await tess::checkpoint(folder, state);
}

tess::Task go_on(std::string folder) {
  auto state = co_await tess::restart<State>(folder);
  co_await tess::checkpoint(folder, state);
}

/// All elements make a section and an array, and use both.
tess::Task use(std::string folder) {
  const auto state = co_await tess::restart<State>(folder);
  co_await tess::epoch([&] {
    for (int i = 0; i < n; ++i) state.makers[{i}].send<&Maker::make>((i + 2) % n, (i + 5) % n);
  });
  co_await tess::epoch([&] {
    for (int i = 0; i < n; ++i)
      for (const int section : {0, 1})
        state.makers[{i}].send<&Maker::call>(static_cast<std::size_t>(section),
                                             section == 0 ? 1 : 100);
  });
  const std::vector<int> found = co_await state.makers.reduce<&Maker::report>();
  CHECK(found == std::vector<int>(n, 202));  // each is in two sections of either kind
  for (const std::size_t array : {0U, 1U}) {
    tess::Future<int> n_leaves;
    state.makers[{n - 1}].send<&Maker::count>(array, n_leaves.callback());
    CHECK(co_await n_leaves == 3);
  }
}

tess::Task time(std::string folder) {
  const auto state = co_await tess::restart<State>(folder);
  const auto n_ticks = std::make_shared<int>(0), n_runs = std::make_shared<int>(0);
  const tess::Timer ticks = tess::every(10ms, [n_ticks] { ++*n_ticks; });
  std::vector<tess::Timer> fresh;
  for (int i = 0; i < 20; ++i) fresh.push_back(tess::after(10ms, [n_runs] { ++*n_runs; }));
  state.timer.cancel();      // it has run, before the checkpoint
  co_await tess::sleep(3s);  // messages are late here by fractions of a second
  ticks.cancel();
  CHECK(*n_ticks > 10);
  CHECK(*n_runs == 20);
}

}  // namespace

TEST_CASE("arrays and sections have new numbers after restarts on fewer and on more PEs",
          "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 5; ++seed)
    for (const int fewer : {1, 2, 4}) {
      const tess::test::Scratch scratch;
      const std::string folder = scratch.path("saved");
      completes(4, seed, [&] { return begin(folder); });
      completes(fewer, seed, [&] { return go_on(folder); });
      for (const int n_pes : {fewer, 3, 4}) completes(n_pes, seed, [&] { return use(folder); });
    }
}

TEST_CASE("timers tick after a restart, and one of the run before names none of them",
          "[runtime][checkpoint]") {
  for (const int n_pes : {1, 4}) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    completes(4, 1, [&] { return begin(folder); });
    completes(n_pes, 2, [&] { return time(folder); });
  }
}

namespace {

/// A single chare that reports where it is.
class Desk : public tess::Chare<Desk> {
 public:
  [[nodiscard]] int pe() const { return tess::my_pe().value; }
  void serialize(auto& /*ar*/) {}
};

struct Desks {
  static constexpr std::size_t n_anywhere = 20;
  std::vector<tess::ChareProxy<Desk>> all;

  static Desks make() {
    Desks desks;
    for (std::size_t i = 0; i < n_anywhere; ++i) desks.all.push_back(tess::create<Desk>(tess::one));
    const std::int32_t last = tess::n_pes() - 1;
    desks.all.push_back(tess::create<Desk>(tess::one_on(tess::PeId{last})));
    return desks;
  }
  tess::Task where(std::vector<int>& places) const {
    for (const auto& desk : all) {
      const int pe = co_await desk.ask<&Desk::pe>();
      places.push_back(pe);
    }
  }
  static tess::Task look(std::vector<int>& places) { co_await make().where(places); }
  static tess::Task save(std::string folder, std::vector<int>& places) {
    const Desks desks = make();
    co_await tess::epoch([&] {
      desks.all[0].migrate_to(tess::PeId{2});
      desks.all[1].migrate_to(tess::PeId{0});
    });
    co_await desks.where(places);
    co_await tess::checkpoint(folder, desks);
  }
  static tess::Task restart(std::string folder, std::vector<int>& places) {
    const auto desks = co_await tess::restart<Desks>(folder);
    co_await desks.where(places);
    co_await tess::checkpoint(folder, desks);
  }
};

/// Where the chares are on a machine on which none migrates by itself.
std::vector<int> places_on(int n_pes, std::uint64_t seed,
                           const std::function<tess::Task(std::vector<int>&)>& main) {
  std::vector<int> places;
  tess::Setup setup = tess::test::adversarial(n_pes, seed);
  setup.options.migration_chance = 0;
  tess::test::completes_on(std::move(setup), [&] { return main(places); });
  return places;
}

}  // namespace

TEST_CASE("single chares are where they were after a restart, or spread as in a new run",
          "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    CAPTURE(seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    const auto restart = [&](std::vector<int>& places) { return Desks::restart(folder, places); };
    const std::vector<int> saved =
        places_on(4, seed, [&](auto& places) { return Desks::save(folder, places); });
    REQUIRE(saved.size() == Desks::n_anywhere + 1);
    CHECK(saved[0] == 2);
    CHECK(saved[1] == 0);
    CHECK(saved.back() == 3);
    CHECK(places_on(4, seed + 100, restart) == saved);
    for (const int n_pes : {3, 7, 7}) {  // the last time on as many as before
      CAPTURE(n_pes);
      std::vector<int> anew = places_on(n_pes, seed, &Desks::look);
      CHECK(std::set<int>(anew.begin(), anew.end()).size() > 2);
      anew.back() = 3 % n_pes;  // of one_on()
      CHECK(places_on(n_pes, seed + 200, restart) == anew);
    }
  }
}
