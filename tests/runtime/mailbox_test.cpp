#include "runtime/mailbox.hpp"

#include "runtime/machine/simulated.hpp"
#include "runtime/runtime.hpp"
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

}  // namespace
