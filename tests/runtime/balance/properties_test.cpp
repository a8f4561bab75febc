// Properties of every strategy, for any input.
#include "apps/bench/balance_scenes.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

using namespace tess;
using namespace tess::balance;

namespace {

void require_legal(const Snapshot& s, const Assignment& a) {
  REQUIRE(a.size() == s.elements.size());
  std::vector<std::uint64_t> before(s.pes.size(), 0);
  std::vector<std::uint64_t> memory(s.pes.size(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].value >= 0);
    REQUIRE(slot(a[i]) < s.pes.size());
    if (!s.elements.migratable[i]) REQUIRE(a[i] == s.elements.pe[i]);
    before[slot(s.elements.pe[i])] += s.elements.memory_bytes[i];
    memory[slot(a[i])] += s.elements.memory_bytes[i];
  }
  for (std::size_t p = 0; p < s.pes.size(); ++p)
    if (s.pes.memory_limit_bytes[p] != 0)
      REQUIRE(memory[p] <= std::max(before[p], s.pes.memory_limit_bytes[p]));
}

}  // namespace

TEST_CASE("every strategy keeps pinned elements, memory limits and its seed", "[balance]") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Snapshot s = anything(seed);
    validate(s);
    for (const std::string& name : strategy_names()) {
      INFO("seed " << seed << ", " << name);
      const Assignment a = make_strategy(name, 7)(s);
      require_legal(s, a);
      REQUIRE(a == make_strategy(name, 7)(s));
    }
  }
}

TEST_CASE("no strategy moves an element of unknown load", "[balance]") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Snapshot s = anything(seed);
    Random draw(seed + 1);
    for (Load& load : s.elements.load)
      if (draw.below(3) == 0) load = Load::unknown();
    validate(s);
    for (const std::string& name : strategy_names()) {
      INFO("seed " << seed << ", " << name);
      const Assignment a = make_strategy(name, 7)(s);
      require_legal(s, a);
      for (std::size_t i = 0; i < a.size(); ++i)
        if (!s.elements.load[i].is_known()) REQUIRE(a[i] == s.elements.pe[i]);
    }
  }
}

TEST_CASE("elements of unknown load weigh as much as the others on average", "[balance]") {
  Snapshot s = idle_pes(2);
  for (std::size_t i = 0; i < 40; ++i) {
    add_element(s, i < 20 ? 0 : 1, 2);
    if (i >= 20) s.elements.load[i] = Load::unknown();
    s.elements.position.push_back({static_cast<double>(i), 0, 0});
  }
  CHECK(measure(s, s.elements.pe).max_over_average == Approx(1));
  // As it is, the two PEs have the same work. One that takes the 20 unknown ones for idle moves
  // half of the others to them.
  for (const std::string& name : strategy_names()) {
    if (name == "rotate" || name == "random") continue;
    INFO(name);
    CHECK(measure(s, make_strategy(name, 1)(s)).n_moves == 0);
  }
}

TEST_CASE("the user's strategy moves nothing of unknown load", "[balance]") {
  Snapshot s = mod_seven(Start::blocks);
  s.elements.load[63] = Load::unknown();
  const auto to_first = [](const Snapshot& x) { return Assignment(x.elements.size(), PeId{0}); };
  const Assignment a = make_strategy(to_first)(s);
  CHECK(a[62] == PeId{0});
  CHECK(a[63] == PeId{3});
}

TEST_CASE("strategies that start from the present placement never make it worse", "[balance]") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Snapshot s = anything(seed);
    for (const char* name : {"none", "refine", "diffusion", "gossip"}) {
      INFO("seed " << seed << ", " << name);
      REQUIRE(measure(s, make_strategy(name, 7)(s)).max_over_average <=
              measure(s, s.elements.pe).max_over_average + 1e-12);
    }
  }
}

TEST_CASE("an element that fits nowhere stays, and only that one", "[balance]") {
  Snapshot s = idle_pes(2);
  for (std::size_t i = 0; i < 9; ++i) {
    add_element(s, 0, 1);
    s.elements.memory_bytes[i] = i == 0 ? 1000 : 10;
    s.elements.position.push_back({static_cast<double>(i), 0, 0});
  }
  s.elements.load[0] = 4;
  s.pes.memory_limit_bytes = {0, 100};
  for (const std::string& name : strategy_names()) {
    if (name == "none" || name == "random") continue;
    INFO(name);
    const Assignment a = make_strategy(name, 1)(s);
    CHECK(a[0] == PeId{0});
    CHECK(measure(s, a).n_moves >= 4);
  }
}

TEST_CASE("faster PEs get more, PEs with background get less", "[balance]") {
  Snapshot s = idle_pes(4);
  for (std::size_t i = 0; i < 400; ++i) {
    add_element(s, i / 100, 1);
    s.elements.position.push_back({static_cast<double>(i), 0, 0});
  }
  s.pes.speed = {1, 1, 0.5, 2};
  s.pes.background = {0, 50, 0, 0};
  for (const std::string& name : strategy_names()) {
    if (name == "none" || name == "random" || name == "rotate") continue;
    INFO(name);
    CHECK(measure(s, make_strategy(name, 1)(s)).max_over_average <= 1.10);
  }
}

TEST_CASE("the user's strategy may not move what is pinned, nor leave the machine", "[balance]") {
  Snapshot s = mod_seven(Start::blocks);
  s.elements.migratable[63] = 0;
  const auto to_first = [](const Snapshot& x) { return Assignment(x.elements.size(), PeId{0}); };
  const Assignment a = make_strategy(to_first)(s);
  CHECK(a[62] == PeId{0});
  CHECK(a[63] == PeId{3});
  CHECK_THROWS_WITH(make_strategy([](const Snapshot&) { return Assignment{}; })(s),
                    Catch::Contains("returned 0 PEs for 64 elements"));
  CHECK_THROWS_WITH(
      make_strategy([](const Snapshot& x) { return Assignment(x.elements.size(), PeId{4}); })(s),
      Catch::Contains("element 0 to PE 4"));
}

TEST_CASE("an unknown strategy is refused with the names that exist", "[balance]") {
  CHECK_THROWS_WITH(make_strategy("gready", 0), Catch::Contains("greedy, greedy_refine, refine"));
}
