// The promises of each strategy, on scenes with a known ideal.
#include "apps/bench/balance_scenes.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategies/diffusion.hpp"
#include "runtime/balance/strategies/gossip.hpp"
#include "runtime/balance/strategies/refine.hpp"
#include "runtime/balance/strategy.hpp"
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

TEST_CASE("refine moves nothing within its tolerance, and stops as soon as it is reached",
          "[balance]") {
  Snapshot s = idle_pes(2);
  for (std::size_t i = 0; i < 200; ++i) add_element(s, i < 106 ? 0 : 1, 1);
  for (const auto& [tolerance, n_moves] : {std::pair{1.065, 0}, {1.055, 1}, {1.025, 4}, {1.0, 6}}) {
    INFO("tolerance " << tolerance);
    const Metrics m = measure(s, refine(s, tolerance));
    CHECK(m.n_moves == static_cast<std::size_t>(n_moves));
    CHECK(m.max_over_average <= tolerance);
  }
}

TEST_CASE("greedy_refine balances as greedy does and moves only the excess", "[balance]") {
  const Snapshot s = heavy_tailed(4096, 128, 1);
  const Metrics few = run(s, "greedy_refine");
  const Metrics all = run(s, "greedy");
  CHECK(few.max_over_average <= 1.03);
  CHECK(2 * few.n_moves <= all.n_moves);
}

TEST_CASE("32 768 heavy-tailed elements on 1 024 PEs are balanced without a global view",
          "[balance]") {
  const Snapshot s = heavy_tailed(32768, 1024, 1);
  REQUIRE(measure(s, s.elements.pe).max_over_average > 10);
  CHECK(run(s, "gossip").max_over_average <= 1.10);
  CHECK(run(s, "hierarchical").max_over_average <= 1.10);
  CHECK(run(s, "diffusion").max_over_average <= 1.10);
}

TEST_CASE("diffusion pairs PEs without conflict and reaches all, whatever their number",
          "[balance]") {
  for (const std::size_t n_pes : {1U, 2U, 3U, 5U, 17U, 64U, 129U}) {
    INFO(n_pes << " PEs");
    for (std::size_t stage = 0; stage < n_stages(n_pes); ++stage)
      for (std::size_t p = 0; p < n_pes; ++p)
        REQUIRE(partner(partner(p, stage, n_pes), stage, n_pes) == p);
    Snapshot s = idle_pes(n_pes);
    for (std::size_t i = 0; i < 64 * n_pes; ++i) add_element(s, n_pes - 1, 1);
    CHECK(run(s, "diffusion").max_over_average <= 1.10);
  }
}

TEST_CASE("a PE of the gossip knows a bounded number of others", "[balance]") {
  GossipPe pe(LocalPe({}), 0, 1.0, 7);
  for (std::size_t i = 1; i < 1000; ++i) pe.hear({{i, {}}});
  CHECK(pe.tell().size() == GossipPe::most_known);
}

TEST_CASE("cuts of space keep a stencil's neighbours together, in balance", "[balance]") {
  const Snapshot s = stencil(64, 16, 1);
  const Metrics by_greedy = run(s, "greedy");
  for (const char* name : {"rcb", "hilbert"}) {
    INFO(name);
    const Metrics m = run(s, name);
    CHECK(m.max_over_average <= 1.05);
    CHECK(8 * m.external_bytes <= by_greedy.external_bytes);
  }
}

TEST_CASE("a partition of a partition moves nothing, whatever its parts were called", "[balance]") {
  for (const char* name : {"rcb", "hilbert", "graph"}) {
    INFO(name);
    Snapshot s = stencil(32, 16, 1);
    s.elements.pe = make_strategy(name, 1)(s);
    for (PeId& pe : s.elements.pe) pe = pe_at((slot(pe) * 7 + 3) % 16);
    CHECK(run(s, name).n_moves == 0);
    // Measured background is equal on no two PEs.
    for (std::size_t pe = 0; pe < 16; ++pe) s.pes.background[pe] = 1e-3 * static_cast<double>(pe);
    CHECK(run(s, name).n_moves < s.elements.size() / 20);
  }
}

TEST_CASE("what a snapshot cannot serve is known before a strategy runs", "[balance]") {
  const Snapshot without = mod_seven(Start::blocks), with = stencil(4, 2, 1);
  for (const std::string& name : strategy_names()) {
    INFO(name);
    const bool by_position = name == "rcb" || name == "hilbert";
    CHECK(needs_positions(name) == by_position);
    for (const Snapshot& s : {without, with}) {
      if (obstacle(name, s).empty()) {
        CHECK_NOTHROW(make_strategy(name, 1)(s));
      } else {
        CHECK_THROWS_AS(make_strategy(name, 1)(s), Error);
      }
    }
    if (by_position) CHECK_THAT(obstacle(name, without), Catch::Contains("positions"));
  }
}

TEST_CASE("strategies by position refuse a snapshot without positions", "[balance]") {
  for (const char* name : {"rcb", "hilbert"})
    CHECK_THROWS_WITH(run(mod_seven(Start::blocks), name), Catch::Contains("has no positions"));
}

TEST_CASE("graph cuts at most half of greedy's external bytes of a stencil", "[balance]") {
  for (const std::size_t n_pes : {4U, 16U}) {
    const Snapshot s = stencil(32, n_pes, 1);
    const Metrics m = run(s, "graph");
    CHECK(m.max_over_average <= 1.10);
    CHECK(2 * m.external_bytes <= run(s, "greedy").external_bytes);
  }
}
