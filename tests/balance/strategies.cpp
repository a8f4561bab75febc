#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/error.hpp"
#include "tests/support/catch.hpp"

#include <random>

using namespace tess;
using namespace tess::balance;

namespace {

void add(Snapshot& s, std::size_t pe, double load, bool migratable, std::uint64_t bytes) {
  auto& e = s.elements;
  e.key.push_back({0, e.size()});
  e.pe.push_back(PeId{static_cast<std::int32_t>(pe)});
  e.load.push_back(load);
  e.migratable.push_back(migratable);
  e.size_bytes.push_back(bytes);
}

Snapshot with_pes(std::size_t n) {
  Snapshot s;
  s.pes = {
      std::vector<double>(n, 0.0), std::vector<double>(n, 1.0), std::vector<std::uint64_t>(n, 0)};
  return s;
}

}  // namespace

TEST_CASE("64 elements of work i mod 7 + 1 on 4 PEs are balanced, by refine in few moves",
          "[balance]") {
  Snapshot s = with_pes(4);
  for (std::size_t i = 0; i < 64; ++i) add(s, i / 16, static_cast<double>(i % 7 + 1), true, 8);
  const Metrics by_greedy = measure(s, greedy(s));
  const Metrics by_refine = measure(s, refine(s));
  CHECK(by_greedy.max_over_average <= 1.05);
  CHECK(by_refine.max_over_average <= 1.10);
  CHECK(3 * by_refine.n_moves <= by_greedy.n_moves);
}

TEST_CASE("every strategy keeps pinned elements, memory limits and its seed", "[balance]") {
  std::mt19937_64 next(1);
  for (int round = 0; round < 500; ++round) {
    Snapshot s = with_pes(1 + next() % 9);
    const std::size_t n = next() % 60;
    std::vector<std::uint64_t> used(s.pes.size(), 0);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t pe = next() % s.pes.size();
      const std::uint64_t bytes = next() % 100;
      used[pe] += bytes;
      add(s, pe, round % 5 == 0 ? 0.0 : static_cast<double>(next() % 50), next() % 4 != 0, bytes);
    }
    for (std::size_t p = 0; p < s.pes.size(); ++p) {
      s.pes.speed[p] = 0.5 + static_cast<double>(next() % 4);
      s.pes.background[p] = static_cast<double>(next() % 10);
      if (next() % 2 == 0) s.pes.memory_limit_bytes[p] = used[p] + 1 + next() % 200;
    }
    validate(s);
    for (const char* name : {"none", "rotate", "random", "greedy", "refine"}) {
      INFO("round " << round << ", " << name);
      const Assignment a = make_strategy(name, 7)(s);
      REQUIRE(a == make_strategy(name, 7)(s));
      REQUIRE(a.size() == n);
      std::vector<std::uint64_t> memory(s.pes.size(), 0);
      for (std::size_t i = 0; i < n; ++i) {
        REQUIRE((a[i].value >= 0 && static_cast<std::size_t>(a[i].value) < s.pes.size()));
        if (!s.elements.migratable[i]) REQUIRE(a[i] == s.elements.pe[i]);
        memory[static_cast<std::size_t>(a[i].value)] += s.elements.size_bytes[i];
      }
      for (std::size_t p = 0; p < s.pes.size(); ++p)
        if (s.pes.memory_limit_bytes[p] != 0) REQUIRE(memory[p] <= s.pes.memory_limit_bytes[p]);
      if (std::string_view(name) == "refine")
        REQUIRE(measure(s, a).max_over_average <=
                measure(s, s.elements.pe).max_over_average + 1e-12);
    }
  }
}

TEST_CASE("an unknown strategy is refused with the names that exist", "[balance]") {
  CHECK_THROWS_WITH(make_strategy("gready", 0), Catch::Contains("greedy, refine"));
}
