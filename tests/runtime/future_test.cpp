// Futures of elements that migrate.
#include "runtime/machine/simulated.hpp"
#include "runtime/machine/threads.hpp"
#include "runtime/runtime.hpp"
#include "runtime/when.hpp"

#include <catch2/catch.hpp>

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
  template <class Ar>
  void serialize(Ar& ar) {
    ar(answer_);
  }

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
