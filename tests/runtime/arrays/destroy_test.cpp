// The end of arrays and groups: what is freed, and the error texts of later uses.
#include "runtime/balance.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <malloc.h>
#ifdef __SANITIZE_ADDRESS__
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();  // of its own runtime library
#endif

namespace {

std::size_t allocated_bytes() {
#ifdef __SANITIZE_ADDRESS__
  return __sanitizer_get_current_allocated_bytes();
#else
  return mallinfo2().uordblks;
#endif
}

class Worker : public tess::Chare<Worker, tess::Index1> {
 public:
  Worker() : ballast_(100) {}
  void work(tess::Callback<double> done) {
    array()[{(index().x + 1) % 16}].send<&Worker::hear>(1.0);
    migrate_to(tess::PeId{(tess::my_pe().value + 1) % tess::n_pes()});
    contribute(tess::sum, 1.0, done);
  }
  void hear(double value) { ballast_[0] += value; }
  void resume_from_sync() {}
  void serialize(auto& ar) { ar(ballast_); }

 private:
  std::vector<double> ballast_;
};

class Member : public tess::Group<Member> {
 public:
  void add(tess::Callback<double> done) { contribute(tess::sum, 1.0, done); }

 private:
  std::vector<double> ballast_ = std::vector<double>(100);
};

/// One round of making, using and ending one of each.
tess::Task use_and_end(int round) {
  const auto workers = tess::create<Worker>(round % 2 == 0 ? tess::range(16) : tess::sparse);
  const auto members = tess::create<Member>(tess::each_pe);
  if (round % 3 == 0)
    tess::start_balancing(workers, {.strategy = round % 2 == 0 ? "greedy" : "diffusion",
                                    .when = tess::BalanceWhen::periodic,
                                    .period = std::chrono::microseconds(1)});
  if (round % 2 != 0) {
    co_await tess::epoch([&] {
      for (int i = 0; i < 16; ++i) workers[{i}].insert();
    });
  }
  tess::Future<double> worked, added;
  workers.broadcast<&Worker::work>(worked.callback());
  members.broadcast<&Member::add>(added.callback());
  CHECK(co_await worked == 16);
  CHECK(co_await added == tess::n_pes());
  co_await tess::epoch([&] {
    workers.destroy();
    members.destroy();
  });
}

tess::Task use_and_end_often(int n_rounds, std::vector<std::size_t>& bytes) {
  for (int round = 0; round < n_rounds; ++round) {
    co_await use_and_end(round);
    if (round % 1000 == 999) bytes.push_back(allocated_bytes());
  }
}

template <class Main>
tests::Ending run(std::int32_t n_pes, Main main) {
  return tests::run(tess::text("pes=", n_pes, ",cost=100ns"), std::move(main));
}

TEST_CASE("ten thousand arrays, groups and balancers that end leave no memory behind",
          "[runtime][destroy]") {
#ifdef TESS_CHECKS_ALL
  constexpr int n_rounds = 3000;
#else
  constexpr int n_rounds = 10'000;
#endif
  std::vector<std::size_t> bytes;
  bytes.reserve(n_rounds / 1000);
  const tests::Ending ending =
      run(4, [&]() -> tess::Task { return use_and_end_often(n_rounds, bytes); });
  CHECK(ending.exit_code == 0);
  CHECK(ending.report == "");
  REQUIRE(bytes.size() == n_rounds / 1000);
  // 8 bytes per round would be 72 KB.
  INFO(bytes.front() << " bytes after 1000 rounds, " << bytes.back() << " after all");
  CHECK(bytes.back() < bytes.front() + 32768);
}

class Waiter : public tess::Chare<Waiter, tess::Index1> {
 public:
  struct Note {
    int key = 0;
  };
  tess::Task wait() { (void)co_await notes_.take(3); }
  void put() { notes_.put(Note{3}); }

 private:
  tess::Mailbox<&Note::key> notes_;
};

TEST_CASE("a coroutine that waits for a message of its destroyed array is reported",
          "[runtime][destroy]") {
  const tests::Ending ending = run(2, [] {
    const auto waiters = tess::create<Waiter>(tess::range(2));
    waiters[{1}].send<&Waiter::wait>();
    waiters[{1}].send<&Waiter::wait>();
    waiters.destroy();
  });
  CHECK(ending.exit_code == 1);
  CHECK(ending.report.find("Waiter on PE 1 was destroyed, but coroutines of its elements wait") !=
        std::string::npos);
  CHECK(ending.report.find("Waiter[1] on PE 1: Waiter::wait waits for a message of key 3") !=
        std::string::npos);
}

tess::Task send_late(int n_ends) {
  const auto waiters = tess::create<Waiter>(tess::range(2));
  co_await tess::epoch([&] {
    for (int i = 0; i < n_ends; ++i) waiters.destroy();
  });
  waiters[{0}].send<&Waiter::put>();
  waiters[{7}].insert();
  waiters.broadcast<&Waiter::put>();
}

TEST_CASE(
    "what is sent to a destroyed array is counted and reported, however often it was destroyed",
    "[runtime][destroy]") {
  for (const int n_ends : {1, 3}) {
    const tests::Ending ending = run(3, [n_ends]() -> tess::Task { return send_late(n_ends); });
    CHECK(ending.exit_code == 0);
    CHECK(ending.report ==
          "tessera: 3 messages to elements that had been destroyed were not delivered\n");
  }
}

/// Its destructor uses its own index: another element is inserted, or a message is sent.
class Phoenix : public tess::Chare<Phoenix, tess::Index1> {
 public:
  Phoenix() = default;
  Phoenix(int life, bool rises) : life_(life), rises_(rises) {}
  Phoenix(const Phoenix&) = delete;
  Phoenix& operator=(const Phoenix&) = delete;
  ~Phoenix() override {
    if (life_ != 1) return;
    if (rises_)
      self().insert(2, false);
    else
      self().send<&Phoenix::burn>();
  }
  void burn() {}
  [[nodiscard]] int life() const { return life_; }
  void count(tess::Callback<int> target) { contribute(tess::sum, life_, target); }
  void serialize(auto& ar) { ar(life_, rises_); }

 private:
  int life_ = 0;
  bool rises_ = false;
};

tess::Task rise(int from, bool rises, int& life, int& sum) {
  const auto birds = tess::create<Phoenix>(tess::sparse);
  co_await tess::epoch([&] {
    birds[{0}].insert_on(tess::PeId{from}, 1, rises);
    birds[{1}].insert(10, false);
  });
  co_await tess::epoch([&] { birds[{0}].destroy(); });
  if (rises) life = co_await birds[{0}].ask<&Phoenix::life>();
  sum = co_await birds.reduce<&Phoenix::count>();
}

TEST_CASE("a destructor inserts at its own index, or sends there", "[runtime][destroy]") {
  for (const int n_pes : {1, 3})
    for (int from = 0; from < n_pes; ++from)
      for (const bool rises : {true, false}) {
        int life = 0, sum = 0;
        const tests::Ending ending =
            run(n_pes, [&]() -> tess::Task { return rise(from, rises, life, sum); });
        INFO(n_pes << " PEs, on " << from << (rises ? ", inserts" : ", sends") << ending.report);
        CHECK(ending.exit_code == 0);
        CHECK(sum == (rises ? 12 : 10));
        CHECK(life == (rises ? 2 : 0));
      }
}

int n_alive = 0;  // one thread runs all simulated PEs

class Last : public tess::Chare<Last, tess::Index1> {
 public:
  Last() { ++n_alive; }
  Last(const Last&) = delete;
  Last& operator=(const Last&) = delete;
  ~Last() override { --n_alive; }
  void end() {
    array().destroy();
    CHECK(n_alive == 5);  // not before this message is done
  }
};

class LastMember : public tess::Group<LastMember> {
 public:
  LastMember() { ++n_alive; }
  LastMember(const LastMember&) = delete;
  LastMember& operator=(const LastMember&) = delete;
  ~LastMember() override { --n_alive; }
  tess::Task end() {
    const tess::Callback<int> target = given_.callback();
    group().destroy();
    group()[pe()].send<&LastMember::nothing>();
    target(7);
    CHECK(co_await given_ == 7);
    CHECK(n_alive >= 1);
  }
  void nothing() {}

 private:
  tess::Future<int> given_;
};

tess::Task end_from_within() {
  const auto array = tess::create<Last>(tess::range(5));
  co_await tess::epoch([&] { array[{3}].send<&Last::end>(); });
  CHECK(n_alive == 0);
  const auto group = tess::create<LastMember>(tess::each_pe);
  co_await tess::epoch([&] { group[tess::PeId{1}].send<&LastMember::end>(); });
  CHECK(n_alive == 0);
  CHECK(group.local_or_null() == nullptr);
  CHECK(tess::current_pe().collections().all().empty());
}

TEST_CASE("an array and a group are ended by their own members", "[runtime][destroy]") {
  const tests::Ending ending = run(3, []() -> tess::Task { return end_from_within(); });
  CHECK(ending.exit_code == 0);
}

class Sleeper : public tess::Chare<Sleeper, tess::Index1> {
 public:
  static inline int n_resumed = 0;
  void rest() { at_sync(); }
  void resume_from_sync() { ++n_resumed; }
};

TEST_CASE(
    "the message that ends an earlier life's wait at the barrier does not end the next life's",
    "[runtime][destroy][balance]") {
  Sleeper::n_resumed = 0;
  const tests::Ending ending = run(1, [] {
    const auto sleepers = tess::create<Sleeper>(tess::range(1));
    tess::start_balancing(sleepers, {.strategy = "greedy"});
    sleepers[{0}].send<&Sleeper::rest>();
    // As if it had been sent to an element that was destroyed meanwhile.
    tess::Pe& pe = tess::current_pe();
    auto* late = tess::detail::Awakening<Sleeper>::make(pe, sleepers.id(), tess::Index1{0});
    sleepers.here().post(late);
  });
  CHECK(ending.exit_code == 0);
  CHECK(Sleeper::n_resumed == 1);
}

/// Asks for its end, and waits for a note before it.
class Leaving : public tess::Chare<Leaving, tess::Index1> {
 public:
  static inline int n_left = 0;
  void hop(int to) { migrate_to(tess::PeId{to % tess::n_pes()}); }
  void meet() {}
  tess::Task leave() {
    destroy();
    (void)co_await notes_.take(3);
    ++n_left;
  }
  void put() { notes_.put(Waiter::Note{3}); }
  void serialize(auto& ar) { ar(notes_); }

 private:
  tess::Mailbox<&Waiter::Note::key> notes_;
};

tess::Task leave_by_multicast() {
  const auto all = tess::create<Leaving>(tess::range(3));
  const auto section = tess::create_section(all, {{0}, {1}, {2}});
  co_await tess::epoch([&] { section.broadcast<&Leaving::meet>(); });
  for (int x = 0; x < 3; ++x) all[{x}].send<&Leaving::leave>();
  co_await tess::sleep(std::chrono::milliseconds(1));
  section.broadcast<&Leaving::put>();
}

TEST_CASE("a member that waits after destroy() receives the multicasts of its section",
          "[runtime][destroy]") {
  Leaving::n_left = 0;
  const tests::Ending ending = run(2, []() -> tess::Task { return leave_by_multicast(); });
  CHECK(ending.exit_code == 0);
  CHECK(ending.report == "");
  CHECK(Leaving::n_left == 3);
}

TEST_CASE("an element that waits after destroy() receives the broadcasts of its journey",
          "[runtime][destroy]") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    Leaving::n_left = 0;
    const auto main = [] {
      const auto all = tess::create<Leaving>(tess::range(6));
      for (int x = 0; x < 6; ++x) all[{x}].send<&Leaving::hop>(x + 1);
      all.broadcast<&Leaving::leave>();
      all.broadcast<&Leaving::put>();
    };
    // Moves may come too late, so the report is not compared.
    CHECK(tests::run(tess::text("pes=4,cost=100ns,seed=", seed), main).exit_code == 0);
    CHECK(Leaving::n_left == 6);
  }
}

}  // namespace
