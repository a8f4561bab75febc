#include "runtime/mailbox.hpp"

#include "runtime/machine/simulated.hpp"
#include "runtime/runtime.hpp"
#include "runtime/when.hpp"
#include "tests/support/catch.hpp"

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
  template <class Ar>
  void serialize(Ar& ar) {
    ar(notes_);
  }

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
    tess::Setup setup;
    tess::SimulatedOptions options;
    options.n_pes = 2;
    options.pes_per_process = pes_per_process;
    options.cost = tess::Time(100);
    setup.machine = tess::make_simulated_machine(options);
    REQUIRE(tess::run(setup, []() -> tess::Task { return fill_and_read(); }) == 0);
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
  tess::Setup setup;
  tess::SimulatedOptions options;
  options.n_pes = 2;
  options.cost = tess::Time(100);
  setup.machine = tess::make_simulated_machine(options);
  REQUIRE(tess::run(setup,
                    [] { tess::create<Returner>(tess::range(2))[{0}].template send<F>(); }) == 0);
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
