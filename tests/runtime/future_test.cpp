// Futures: moved, members of elements that migrate, and without a value.
#include "runtime/future.hpp"

#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/over_seeds.hpp"

#include <cstdint>
#include <memory>

namespace {

using namespace std::chrono_literals;

class Oracle : public tess::Chare<Oracle> {
 public:
  void answer(tess::Callback<int> target) { target(7); }
};

/// Asks on one PE, and reads the answer on another.
class Pilgrim : public tess::Chare<Pilgrim> {
 public:
  void ask(tess::ElementProxy<Oracle> oracle) {
    // Not a member: with all checks an element is packed and made anew within a process, too.
    auto* const answer = new tess::Future<int>;
    answer_ = reinterpret_cast<std::uintptr_t>(answer);
    oracle.send_after<&Oracle::answer>(20ms, answer->callback());
  }
  void go() { migrate_to(tess::PeId{1}); }
  tess::Task read(tess::Callback<int> target) {
    CHECK(tess::my_pe() == tess::PeId{1});
    const std::unique_ptr<tess::Future<int>> answer(reinterpret_cast<tess::Future<int>*>(answer_));
    target(co_await *answer);
  }
  void serialize(auto& ar) { ar(answer_); }

 private:
  std::uintptr_t answer_ = 0;
};

}  // namespace

TEST_CASE("a result that comes after an element has gone is found by it", "[runtime][future]") {
  for (const bool threads : {false, true}) {
    tess::Setup setup{tess::make_threads_machine(2), {}};
    if (!threads) {
      tess::SimulatedOptions options;
      options.n_pes = 2;
      setup.machine = tess::make_simulated_machine(options);
    }
    int answer = 0;
    REQUIRE(tess::run(setup, [&]() -> tess::Task {
              const auto oracle = tess::create<Oracle>(tess::range(1))[{0}];
              const auto pilgrim = tess::create<Pilgrim>(tess::range(1))[{0}];
              co_await pilgrim.ask<&Pilgrim::ask>(oracle);
              co_await tess::epoch([&] { pilgrim.send<&Pilgrim::go>(); });
              co_await tess::sleep(200ms);  // the answer comes to PE 0
              tess::Future<int> read;
              pilgrim.send<&Pilgrim::read>(read.callback());
              answer = co_await read;
            }) == 0);
    CHECK(answer == 7);
  }
}

namespace {

class Node : public tess::Chare<Node> {
 public:
  void there(tess::Callback<void> target) { contribute(target); }
  void tell(tess::Callback<int> target) { target(value_); }
  void large(std::uint64_t n) { value_ = static_cast<int>(n); }
  void begin() {
    result_ = tess::Future<int>();
    const tess::Task waiting = wait();
    self().send<&Node::finish>(result_.callback());
  }
  tess::Task wait() { value_ = co_await result_; }
  void finish(tess::Callback<int> target) { target(77); }

 private:
  tess::Future<int> result_;
  int value_ = 0;
};

class Adder : public tess::Group<Adder> {
 public:
  void add(int value) { n_ += value; }
  [[nodiscard]] int n() { return n_; }

 private:
  int n_ = 0;
};

tess::Future<int> told_by(tess::ElementProxy<Node> node) {
  tess::Future<int> value;
  node.send<&Node::tell>(value.callback());
  return value;
}
/// Has a future as a member, and awaits it on several PEs.
class Traveller : public tess::Chare<Traveller> {
 public:
  void give(tess::Callback<int> target) { target(tess::my_pe().value); }
  tess::Task ask_itself(tess::Callback<int> target) {
    if (n_asked_++ > 0) news_ = tess::Future<int>();
    const auto own = news_.callback();
    using Place = std::tuple<tess::PeId, std::uint64_t>;
    CHECK(std::get<0>(tess::from_bytes<Place>(own.where())) == tess::my_pe());
    self().send<&Traveller::give>(own);
    const int pe = co_await news_;
    target(pe);
  }
  void serialize(auto& ar) { ar(n_asked_); }

 private:
  tess::Future<int> news_;
  int n_asked_ = 0;
};

tess::Task travel() {
  const auto travellers = tess::create<Traveller>(tess::range(1));
  for (const int to : {1, 0, 1, 2, 3}) {
    co_await tess::epoch([&] { travellers[{0}].migrate_to(tess::PeId{to}); });
    tess::Future<int> met;
    travellers[{0}].send<&Traveller::ask_itself>(met.callback());
    const int pe = co_await met;
    CHECK(pe == to);
  }
}

}  // namespace

TEST_CASE("a result without a value: futures, targets, reductions", "[runtime][future]") {
  tests::over_seeds(20, tests::two_processes, []() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(7));
    tess::Future<void> there;
    nodes.broadcast<&Node::there>(there.callback());
    co_await there;

    // A target that takes no value: begin() makes a member future, whose result sets the value.
    co_await tess::epoch([&] { nodes[{3}].target<&Node::begin>()(); });
    tess::Future<int> value;
    nodes[{3}].send<&Node::tell>(value.callback());
    CHECK(co_await value == 77);
    co_await tess::epoch([&] { nodes.target<&Node::begin>()(); });
    tess::Future<int> last;
    nodes[{6}].send<&Node::tell>(last.callback());
    CHECK(co_await last == 77);

    const auto members = tess::create<Adder>(tess::each_pe);
    const tess::Callback<int> all = members.target<&Adder::add>();
    co_await tess::epoch([&] { all(5); });
    for (int pe = 0; pe < tess::n_pes(); ++pe) {
      const int n = co_await members[tess::PeId{pe}].ask<&Adder::n>();
      CHECK(n == 5);
    }
  });
}

TEST_CASE("a future is moved, also once its result is there", "[runtime][future]") {
  tests::over_seeds(20, tests::two_processes, []() -> tess::Task {
    const auto nodes = tess::create<Node>(tess::range(3));
    std::vector<tess::Future<int>> all;
    for (int i = 0; i < 3; ++i) nodes[{i}].send<&Node::tell>(all.emplace_back().callback());
    co_await tess::epoch([&] { nodes.broadcast<&Node::large>(5); });
    std::vector<tess::Future<int>> moved;
    for (tess::Future<int>& one : all) moved.push_back(std::move(one));
    for (std::size_t i = 0; i + 1 < moved.size(); ++i) CHECK(co_await moved[i] % 5 == 0);
    CHECK(co_await std::move(moved.back()) % 5 == 0);
    CHECK(co_await told_by(nodes[{2}]) % 5 == 0);
  });
}

TEST_CASE("a future that is a member has its result on the PE where it is used",
          "[runtime][future]") {
  tests::over_seeds(20, tests::two_processes, &travel);
}
