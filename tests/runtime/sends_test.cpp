// Priorities and attributes of entry methods, as programs use them.
#include "runtime/sends.hpp"

#include "runtime/more/process_group.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/singleton.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/over_seeds.hpp"

#include <string>
#include <vector>

namespace {

std::vector<std::string> said;  // on PE 0
int depth_now = 0, deepest = 0;

class Actor : public tess::Chare<Actor> {
 public:
  void say(std::string word) { said.push_back(std::move(word)); }
  void say_soon(std::string word) { said.push_back(std::move(word)); }
  void say_at_once(std::string word) { said.push_back(std::move(word)); }
  void throw_at_once() { throw std::runtime_error("thrown inside a send"); }
  void on_demand(std::string word) { said.push_back(std::move(word)); }

  void act_by_priority() {
    const auto other = array()[{1}];
    other.with(tess::Priority{1}).send<&Actor::say>("late");
    other.send<&Actor::say>("plain");
    other.with(tess::Priority{-1}).send<&Actor::say>("early");
    other.send<&Actor::say_soon>("by the class");
    other.with(tess::expedited).send<&Actor::say>("expedited");
    other.with(tess::Priority{2}).send<&Actor::say_soon>("last");
    array()[{1}].with(tess::Priority{0}).send<&Actor::say>("plain, too");
  }
  void act_by_broadcast() {
    array()[{1}].send<&Actor::say>("message");
    array().with(tess::Priority{-1}).broadcast<&Actor::say>("broadcast");
    array()[{1}].send<&Actor::say>("message");
  }
  tess::Task act_by_section() {
    const auto section = tess::create_section(array(), {{0}, {1}});
    co_await tess::epoch([&] { section.broadcast<&Actor::say>("known"); });
    section.broadcast<&Actor::say_soon>("by the class");
    array()[{1}].with(tess::Priority{-8}).send<&Actor::say>("earlier");
    array()[{1}].send<&Actor::say>("plain");
  }
  tess::Task act_by_ask() {
    array()[{1}].send<&Actor::say>("plain");
    co_await array()[{1}].ask<&Actor::say_soon>("by the class");
  }
  void act_inline() {
    array()[{1}].send<&Actor::say_at_once>("other");
    said.push_back("after other");
    self().send<&Actor::say_at_once>("self");
    said.push_back("after self");
  }
  void dive() {
    deepest = std::max(deepest, ++depth_now);
    if (index().x < 99) array()[{index().x + 1}].send<&Actor::dive>();
    --depth_now;
  }
  void send_to_thrower() {
    array()[{1}].send<&Actor::throw_at_once>();
    said.push_back("goes on");
  }
  void leave_inside() {
    array()[{1}].send<&Actor::end_at_once>();
    array()[{1}].send<&Actor::say_at_once>("never");
  }
  void end_at_once() { destroy(); }
  void go_at_once() { migrate_to(tess::PeId{1}); }
  template <auto F>
  void keep_local() {
    const Actor* const other = array().local({1});
    array()[{1}].send<F>();
    said.push_back(array().local({1}) == other ? "still here" : "gone");
    self().send<&Actor::look_for_other>();
  }
  void look_for_other() { said.push_back(array().local({1}) == nullptr ? "gone" : "still here"); }

  void serialize(auto& /*ar*/) {}

  using EntryAttributes =
      tess::Attributes<tess::EntryMethod<&Actor::say_soon, tess::Priority{-7}>,
                       tess::EntryMethod<&Actor::say_at_once, tess::inline_when_local>,
                       tess::EntryMethod<&Actor::throw_at_once, tess::inline_when_local>,
                       tess::EntryMethod<&Actor::end_at_once, tess::inline_when_local>,
                       tess::EntryMethod<&Actor::go_at_once, tess::inline_when_local>,
                       tess::EntryMethod<&Actor::dive, tess::inline_when_local>,
                       tess::EntryMethod<&Actor::on_demand, tess::create_here, tess::expedited>>;
};

template <auto F>
int act(int n_actors, int n_pes = 1) {
  said.clear();
  tess::Setup setup{tess::make_threads_machine(n_pes), {}};
  setup.options.report = [](const std::string& line) { said.push_back(line); };
  return tess::run(setup,
                   [&] { tess::create<Actor>(tess::range(n_actors))[{0}].template send<F>(); });
}

}  // namespace

TEST_CASE("the messages of an entry method run by priority", "[runtime][priority]") {
  REQUIRE(act<&Actor::act_by_priority>(2) == 0);
  CHECK(said == std::vector<std::string>{"expedited", "by the class", "early", "plain",
                                         "plain, too", "late", "last"});
}

TEST_CASE("a broadcast with a priority overtakes messages without one", "[runtime][priority]") {
  REQUIRE(act<&Actor::act_by_broadcast>(2) == 0);
  CHECK(said == std::vector<std::string>{"broadcast", "broadcast", "message", "message"});
}

TEST_CASE("a section's broadcast has the priority of its entry method", "[runtime][priority]") {
  REQUIRE(act<&Actor::act_by_section>(2) == 0);
  CHECK(said == std::vector<std::string>{"known", "known", "earlier", "by the class",
                                         "by the class", "plain"});
}

TEST_CASE("an awaited call has the priority of its entry method", "[runtime][priority]") {
  REQUIRE(act<&Actor::act_by_ask>(2) == 0);
  CHECK(said == std::vector<std::string>{"by the class", "plain"});
}

TEST_CASE("an inline entry method runs inside send(), but not inside its own element",
          "[runtime][priority]") {
  REQUIRE(act<&Actor::act_inline>(2) == 0);
  CHECK(said == std::vector<std::string>{"other", "after other", "after self", "self"});
}

TEST_CASE("a chain of inline entry methods has a bounded depth", "[runtime][priority]") {
  deepest = depth_now = 0;
  REQUIRE(act<&Actor::dive>(100) == 0);
  CHECK(deepest == 17);  // the first is not inside another
}

TEST_CASE("an exception of an inline entry method ends the job and names its element",
          "[runtime][priority]") {
  REQUIRE(act<&Actor::send_to_thrower>(2) == 1);
  REQUIRE(said.size() == 2);
  CHECK(said[0] == "goes on");
  CHECK_THAT(said[1], Catch::Contains("thrown inside a send") && Catch::Contains("Actor[1], in") &&
                          Catch::Contains("throw_at_once"));
}

TEST_CASE("an element that ends inside a send() gets no more messages", "[runtime][priority]") {
  REQUIRE(act<&Actor::leave_inside>(2) == 0);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("1 message to an element that had been destroyed"));
}

TEST_CASE("an element that ends or moves inside a send() stays until the sender's message is done",
          "[runtime][priority]") {
  REQUIRE(act<&Actor::keep_local<&Actor::end_at_once>>(2) == 0);
  CHECK(said == std::vector<std::string>{"still here", "gone"});
  REQUIRE(act<&Actor::keep_local<&Actor::go_at_once>>(4, 2) == 0);
  CHECK(said == std::vector<std::string>{"still here", "gone"});
}

TEST_CASE("an entry method that creates on demand needs no other call", "[runtime][priority]") {
  said.clear();
  tess::Setup setup{tess::make_threads_machine(1), {}};
  REQUIRE(tess::run(setup, [] {
            tess::create<Actor>(tess::sparse)[{5}].send<&Actor::on_demand>("here");
          }) == 0);
  CHECK(said == std::vector<std::string>{"here"});
}

namespace {

/// Is created by the first call, and says where.
class OnCall : public tess::Chare<OnCall> {
 public:
  [[nodiscard]] int come_here() { return tess::my_pe().value; }
  [[nodiscard]] int come_home() { return tess::my_pe().value; }
  using EntryAttributes =
      tess::Attributes<tess::EntryMethod<&OnCall::come_here, tess::create_here>,
                       tess::EntryMethod<&OnCall::come_home, tess::create_home>>;
};

tess::Task summon(std::vector<int>& places) {
  const auto all = tess::create<OnCall>(tess::sparse);
  std::vector<tess::Index1> away;  // their home is the other PE
  for (int x = 0; away.size() < 3; ++x)
    if (all.here().home({x}) != tess::my_pe()) away.push_back({x});
  places.push_back(co_await all[away[0]].ask<&OnCall::come_here>());
  places.push_back(co_await all[away[1]].ask<&OnCall::come_home>());
  places.push_back(co_await all[away[2]].with(tess::expedited).ask<&OnCall::come_here>());
}

}  // namespace

TEST_CASE("an awaited call creates its element where the entry method's attributes say",
          "[runtime][priority]") {
  std::vector<int> places;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return summon(places); }) == 0);
  CHECK(places == std::vector<int>{0, 1, 0});
}

namespace {

/// Takes a proxy with its way of sending, and uses it as each proxy is used.
class ProxyUser : public tess::Chare<ProxyUser> {
 public:
  using Urgent = tess::With<tess::ElementProxy<ProxyUser, tess::Index1>, tess::Priority>;
  void use(Urgent to, tess::ArrayProxy<ProxyUser> all) {
    self().with(tess::Priority{3}).target<&ProxyUser::note>()(3);
    all.with(tess::Priority{2}).target<&ProxyUser::note>()(2);
    tess::create_section(all, {{0}}).with(tess::Priority{1}).broadcast<&ProxyUser::note>(1);
    to.send<&ProxyUser::note>(-1);
    to.with(tess::expedited).send<&ProxyUser::note>(-2);
  }
  void note(int number) { order.push_back(number); }
  [[nodiscard]] int place() { return tess::my_pe().value; }
  std::vector<int> order;
};

class Looker : public tess::Group<Looker> {
 public:
  void look(tess::ArrayProxy<ProxyUser> all, tess::Callback<int> target) {
    contribute(tess::sum, all.ended() ? 0 : static_cast<int>(all.size()), target);
  }
  void count(tess::ArrayProxy<ProxyUser> all, tess::Callback<int> target) {
    contribute(tess::sum, static_cast<int>(all.destroyed_here().first), target);
  }
};

struct WideShelf {
  int width = 2;
  [[nodiscard]] int times(int n) const { return n * width; }
};

}  // namespace

TEST_CASE("a proxy with a priority is a value: sent, asked, a target", "[runtime][priority]") {
  tess::Setup setup{tess::make_threads_machine(1), {}};
  std::vector<int> order;
  REQUIRE(tess::run(setup, [&order]() -> tess::Task {
            const auto all = co_await tess::create<ProxyUser>(tess::range(1));
            co_await tess::epoch(
                [&] { all[{0}].send<&ProxyUser::use>(all[{0}].with(tess::Priority{-1}), all); });
            order = all.local({0})->order;
            CHECK(co_await all[{7}].with(tess::create_home).ask<&ProxyUser::place>() == 0);
          }) == 0);
  CHECK(order == std::vector<int>{-2, -1, 1, 2, 3});
}

TEST_CASE("the hash of a proxy with a priority depends on the priority", "[runtime][proxy]") {
  const tess::ElementProxy<Actor> actor(tess::CollectionId{7}, {3});
  const auto first = actor.with(tess::Priority{1}), second = actor.with(tess::Priority{2});
  CHECK(first.hash() == actor.with(tess::Priority{1}).hash());
  CHECK(first.hash() != second.hash());
  CHECK(first.hash() != first.with(tess::create_home).hash());
  CHECK(actor.with(tess::create_here).hash() != actor.with(tess::create_home).hash());
}

namespace {

/// Waits for a while, and counts those that live.
class NapElement : public tess::Chare<NapElement> {
 public:
  NapElement() { ++n_alive; }
  NapElement(const NapElement&) = delete;
  NapElement& operator=(const NapElement&) = delete;
  ~NapElement() { --n_alive; }
  tess::Task nap() { co_await tess::sleep(std::chrono::milliseconds(1 + index().x)); }
  static inline int n_alive = 0;
};

}  // namespace

TEST_CASE("each awaited end of an array waits until all PEs have freed it, whichever came first",
          "[runtime][proxy]") {
  tests::over_seeds(50, tests::two_processes, []() -> tess::Task {
    const auto all = co_await tess::create<NapElement>(tess::range(8));
    all.broadcast<&NapElement::nap>();
    co_await tess::sleep(std::chrono::microseconds(500));
    all.destroy();
    co_await all.destroy();
    CHECK(NapElement::n_alive == 0);
  });
}

TEST_CASE("an awaited creation is known on every PE, an awaited end is over on every PE",
          "[runtime][proxy]") {
  tests::over_seeds(200, tests::two_processes, []() -> tess::Task {
    const auto lookers = tess::create<Looker>(tess::each_pe);
    const auto all = co_await tess::create<ProxyUser>(tess::range(5));
    CHECK(co_await lookers.reduce<&Looker::look>(all) == 5 * 4);
    co_await all[{3}].destroy();
    CHECK(co_await lookers.reduce<&Looker::count>(all) == 1);
    co_await all.destroy();
    CHECK(all.ended());
    CHECK(co_await lookers.reduce<&Looker::look>(all) == 0);
    const auto one = co_await tess::create<ProxyUser>(tess::one);
    CHECK(co_await one.ask<&ProxyUser::place>() >= 0);
    co_await one.destroy();
    const auto shelves = co_await tess::create<WideShelf>(tess::each_process);
    CHECK(co_await shelves[tess::ProcessId{1}].ask<&WideShelf::times>(21) == 42);
    shelves.destroy();
  });
}
