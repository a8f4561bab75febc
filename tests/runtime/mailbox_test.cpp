#include "runtime/mailbox.hpp"

#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

namespace {

struct Note {
  int key = 0;
  int number = 0;
};
std::vector<int> taken;  // one thread runs all simulated PEs

class Reader : public tess::Chare<Reader, tess::Index1> {
 public:
  void fill() {
    for (int number = 0; number < 4; ++number) {
      notes_.put(Note{7, number});
      notes_.put(Note{8, 100 + number});
    }
    migrate_to(tess::PeId{1});  // the order travels with them
  }
  tess::Task read() {
    for (int i = 0; i < 4; ++i) taken.push_back((co_await notes_.take(7)).number);
    for (int i = 0; i < 4; ++i) taken.push_back((co_await notes_.take(8)).number);
  }
  void serialize(auto& ar) { ar(notes_); }

 private:
  tess::Mailbox<&Note::key> notes_;
};

tess::Task fill_and_read() {
  const auto readers = tess::create<Reader>(tess::range(1));
  co_await tess::epoch([&] { readers[{0}].send<&Reader::fill>(); });
  readers[{0}].send<&Reader::read>();
}

TEST_CASE("messages of one key are taken in the order in which they were put",
          "[runtime][mailbox]") {
  for (const int pes_per_process : {1, 2}) {
    taken.clear();
    const std::string keys = tess::text("pes=2,cost=100ns,per-process=", pes_per_process);
    REQUIRE(tests::run(keys, [] { return fill_and_read(); }).exit_code == 0);
    CHECK(taken == std::vector<int>{0, 1, 2, 3, 100, 101, 102, 103});
  }
}

/// Waits for several notes at once and puts back those that it cannot use.
class Returner : public tess::Chare<Returner, tess::Index1> {
 public:
  void refuse() { tess::fail(tess::ErrorCode::bad_value, "refused"); }
  void fail_with_three() {
    put_three();
    (void)take_three();
  }
  /// The same while another coroutine waits for a note.
  void fail_before_another() {
    put_three();
    (void)take_three();
    (void)take_first();
  }
  /// All come in one message, while it waits for any of them.
  tess::Task choose() {
    self().send<&Returner::put_four>();
    (void)co_await tess::when_any(notes_.take(8), notes_.take(7), notes_.take(7), notes_.take(7));
    take_rest();
  }
  void put_three() {
    for (int number = 0; number < 3; ++number) notes_.put(Note{7, number});
  }
  void put_four() {
    notes_.put(Note{8, 100});
    put_three();
  }

 private:
  tess::Task take_three() {
    try {
      (void)co_await tess::when_all(notes_.take(7), notes_.take(7), notes_.take(7),
                                    array()[{1}].ask<&Returner::refuse>());
    } catch (const tess::Error&) {
      take_rest();
    }
  }
  tess::Task take_first() { first = (co_await notes_.take(7)).number; }
  void take_rest() {
    while (notes_.size() > 0) (void)take_one();
  }
  tess::Task take_one() { taken.push_back((co_await notes_.take(7)).number); }

  tess::Mailbox<&Note::key> notes_;

 public:
  static inline int first = -1;
};

template <auto F>
void put_back() {
  taken.clear();
  Returner::first = -1;
  const auto main = [] { tess::create<Returner>(tess::range(2))[{0}].template send<F>(); };
  REQUIRE(tests::run("pes=2,cost=100ns", main).exit_code == 0);
}

enum class Side { left, right };
struct Place {
  int step = 0;
  Side side{};
  friend auto operator<=>(const Place&, const Place&) = default;
};
struct Edge {
  Place place;
  int value = 0;
};
struct Half {
  Side side{};
};

/// Its mailboxes have an aggregate and an enum as keys.
class Joiner : public tess::Chare<Joiner> {
 public:
  tess::Task join() {
    for (const Side side : {Side::left, Side::right})
      taken.push_back((co_await edges_.take({2, side})).value);
    (void)co_await tess::when_any(edges_.take({7, Side::right}), halves_.take(Side::right));
  }
  void put(int step, Side side, int value) { edges_.put({{step, side}, value}); }

 private:
  tess::Mailbox<&Edge::place> edges_;
  tess::Mailbox<&Half::side> halves_;
};

TEST_CASE("a mailbox's key may be an aggregate or an enum, which a report prints",
          "[runtime][mailbox]") {
  taken.clear();
  std::vector<std::string> said;
  tess::Setup setup;
  setup.machine = tess::make_simulated_machine({});
  setup.options.report = [&said](const std::string& line) { said.push_back(line); };
  CHECK(tess::run(setup, [] {
          const auto joiner = tess::create<Joiner>(tess::range(1))[0];
          joiner.send<&Joiner::put>(2, Side::right, 12);
          joiner.send<&Joiner::put>(3, Side::left, 13);
          joiner.send<&Joiner::put>(2, Side::left, 11);
          joiner.send<&Joiner::join>();
        }) == 1);
  CHECK(taken == std::vector<int>{11, 12});
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("a message of key [7,1] (") &&
                          Catch::Contains("::Edge) or a message of key [1] ("));
}

TEST_CASE("messages of one key that are put back together keep their order", "[runtime][mailbox]") {
  put_back<&Returner::fail_with_three>();
  CHECK(taken == std::vector<int>{0, 1, 2});
  put_back<&Returner::choose>();
  CHECK(taken == std::vector<int>{0, 1, 2});
  put_back<&Returner::fail_before_another>();
  CHECK(Returner::first == 0);
  CHECK(taken == std::vector<int>{1, 2});
}

}  // namespace

namespace {

class Taker : public tess::Chare<Taker> {
 public:
  tess::Task read(int waiter) {
    const Note note = co_await notes_.take(7);
    taken.push_back(10 * waiter + note.number);
  }
  void put(int number) { notes_.put(Note{7, number}); }

 private:
  tess::Mailbox<&Note::key> notes_;
};

}  // namespace

TEST_CASE("a message goes to the coroutine that has waited longest", "[runtime][mailbox]") {
  taken.clear();
  const auto main = [] {
    const auto takers = tess::create<Taker>(tess::range(1));
    for (int i = 1; i <= 4; ++i) takers[{0}].send<&Taker::read>(i);
    for (int i = 1; i <= 4; ++i) takers[{0}].send<&Taker::put>(i);
  };
  REQUIRE(tests::run("pes=1,cost=100ns", main).exit_code == 0);
  CHECK(taken == std::vector<int>{11, 22, 33, 44});
}
