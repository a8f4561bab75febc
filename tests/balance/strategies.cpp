// What each strategy promises, on scenes whose ideal is known.
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategy.hpp"
#include "tests/balance/scenes.hpp"
#include "tests/support/catch.hpp"

using namespace tess;
using namespace tess::balance;

namespace {

Metrics run(const Snapshot& s, const char* name) {
  return measure(s, make_strategy(name, 1)(s));
}

}  // namespace

TEST_CASE("work i mod 7 + 1 in blocks is balanced, by refine in a third of greedy's moves",
          "[balance]") {
  const Snapshot s = mod_seven(Start::blocks);
  REQUIRE(measure(s, s.elements.pe).max_over_average > 1.03);
  const Metrics by_greedy = run(s, "greedy");
  const Metrics by_refine = run(s, "refine");
  CHECK(by_greedy.max_over_average <= 1.05);
  CHECK(by_refine.max_over_average <= 1.10);
  CHECK(3 * by_refine.n_moves <= by_greedy.n_moves);
}

TEST_CASE("work i mod 7 + 1 all on one PE is balanced", "[balance]") {
  const Snapshot s = mod_seven(Start::all_on_first);
  REQUIRE(measure(s, s.elements.pe).max_over_average == Approx(4));
  CHECK(run(s, "greedy").max_over_average <= 1.05);
  CHECK(run(s, "greedy_refine").max_over_average <= 1.05);
  CHECK(run(s, "refine").max_over_average <= 1.10);
}

TEST_CASE("greedy_refine balances as greedy does and moves only the excess", "[balance]") {
  const Snapshot s = heavy_tailed(4096, 128, 1);
  const Metrics few = run(s, "greedy_refine");
  const Metrics all = run(s, "greedy");
  CHECK(few.max_over_average <= 1.03);
  CHECK(2 * few.n_moves <= all.n_moves);
}
