// Elements whose serialize() throws where it packs them: the run ends, and the report has the text
// of the exception and names the element.
#include "runtime/balance.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <new>
#include <stdexcept>

namespace {

using namespace tess;

/// Packing throws the next time but this many, and whether that is for lack of memory.
int n_before_throwing = -1;
bool is_memory = false;

class Brittle : public Chare<Brittle> {
 public:
  void step() {}
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    if (Ar::is_reading || index().x != 2 || n_before_throwing < 0 || n_before_throwing-- > 0)
      return;
    if (is_memory) throw std::bad_alloc();
    throw std::runtime_error("it would break");
  }
};

Task migrate() {
  const auto all = create<Brittle>(range(4));
  co_await epoch([&] { all.broadcast<&Brittle::step>(); });
  co_await epoch([&] {
    for (int i = 0; i < 4; ++i) all[{i}].migrate_to(PeId{(i + 1) % n_pes()});
  });
}

/// The first round measures the size of all elements.
Task weigh() {
  const auto all = create<Brittle>(range(4));
  const BalancerProxy balancer = start_balancing(all, {.strategy = "rotate"});
  co_await balancer.begin_phase();
  co_await epoch([&] { all.broadcast<&Brittle::step>(); });
  co_await balancer.round();
}

/// The report of the run, whose packing throws after it has succeeded `n_before` times.
std::string report_of(Task (*main)(), int n_before, bool memory, std::uint64_t seed) {
  n_before_throwing = n_before;
  is_memory = memory;
  const test::Machine machine{.pes = 4, .per_process = 1, .seed = seed, .migration = 0};
  const test::Result ended = machine.run(main);
  CHECK(n_before_throwing == -1);
  CHECK(ended.exit_code == (memory ? 2 : 1));
  std::string all;
  for (const std::string& line : ended.report) all += line + "\n";
  return all;
}

}  // namespace

TEST_CASE("an exception of serialize() ends a migration with its text and the element",
          "[runtime][collections]") {
  for (std::uint64_t seed = 0; seed < 6; ++seed)
    for (const int n_before : {0, 1}) {  // where the bytes are counted, and where they are written
      CAPTURE(seed, n_before);
      CHECK_THAT(report_of(&migrate, n_before, false, seed),
                 Catch::Contains("it would break") && Catch::Contains("Brittle[2]"));
      CHECK_THAT(report_of(&migrate, n_before, true, seed),
                 Catch::Contains("memory is exhausted") && Catch::Contains("Brittle[2]"));
    }
}

TEST_CASE("an exception of serialize() ends a balance round that measures sizes",
          "[runtime][collections]") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    CHECK_THAT(report_of(&weigh, 0, false, seed),
               Catch::Contains("it would break") && Catch::Contains("Brittle[2]"));
    CHECK_THAT(report_of(&weigh, 0, true, seed),
               Catch::Contains("memory is exhausted") && Catch::Contains("Brittle[2]"));
  }
}
