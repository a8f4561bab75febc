// The workloads' answers: the same under every cut, strategy, schedule and forced migration.
#include "apps/lb_lab/run/kind.hpp"
#include "apps/lb_lab/workload/kernel.hpp"
#include "apps/lb_lab/workload/patch.hpp"
#include "tests/apps/lb_lab/on_simulated.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <set>

using namespace lb_lab;

namespace {

Settings small() {
  Settings s;
  s.workloads = {"all"};
  s.per_pe = {1, 2, 4};
  s.n_iterations = 9;
  s.period = 2;
  s.grain = "10us";
  s.cell_bytes = 64;
  s.message_bytes = 40;
  return s;
}

}  // namespace

TEST_CASE("a cut has every cell once, and neighbours agree that they are", "[lb_lab]") {
  for (const Domain whole : {line_of(60), plane_of(60), plane_of(7)}) {
    for (const std::int32_t n : {1, 2, 4, 7}) {
      const Domain domain = cut(whole, n);
      REQUIRE(domain.n_elements() == n);
      std::set<std::uint64_t> seen;
      for (std::int32_t e = 0; e < n; ++e) {
        const Block block = domain.block(e);
        REQUIRE((block.width > 0 && block.height > 0));
        for (std::int32_t y = 0; y < block.height; ++y)
          for (std::int32_t x = 0; x < block.width; ++x)
            REQUIRE(seen.insert(domain.number({block.first.x + x, block.first.y + y})).second);
        for (const Side side : all_sides) {
          const std::int32_t other = domain.neighbour(e, side);
          if (other < 0) continue;
          REQUIRE(domain.neighbour(other, opposite(side)) == e);
        }
      }
      REQUIRE(seen.size() == static_cast<std::size_t>(domain.n_cells()));
    }
  }
  CHECK_THROWS_WITH(cut(line_of(4), 5), Contains("4 x 1") && Contains("5 blocks"));
}

TEST_CASE("a walk returns to its word, after any number of steps", "[lb_lab]") {
  for (std::uint64_t n = 0; n < 1000; n += 7) CHECK(walk(n * n + 3, n) == n * n + 3);
}

TEST_CASE("a chare of the finest cut carries the bytes of --cell-bytes on lines and planes",
          "[lb_lab]") {
  for (const char* name : {"linear", "stencil"}) {
    const Problem p = problem_of(small(), find_workload(name), 4);
    std::size_t n_words = 0;
    const Block block = p.domain.block(0);
    for (std::int32_t y = 0; y < block.height; ++y)
      for (std::int32_t x = 0; x < block.width; ++x)
        n_words += cargo_of(p, {block.first.x + x, block.first.y + y}).size();
    CHECK(8 * n_words == small().cell_bytes);
  }
}

TEST_CASE("a missing neighbour changes the answer where the workload looks", "[lb_lab]") {
  Settings s = small();
  for (std::uint32_t w = 0; w < workloads().size(); ++w) {
    if (workloads()[w].kind != &cells_kind) continue;
    Problem p = problem_of(s, w, 2);
    Patch whole(p, {{0, 0}, p.domain.width, p.domain.height});
    p.domain = cut(p.domain, 2);
    std::uint64_t cut_off = 0;
    for (std::int32_t e = 0; e < 2; ++e) {
      Patch half(p, p.domain.block(e));
      for (std::int32_t t = 0; t < p.n_iterations; ++t) half.advance(p, t);
      cut_off += half.answer(p);
    }
    for (std::int32_t t = 0; t < p.n_iterations; ++t) whole.advance(p, t);
    INFO(workloads()[w].name);
    CHECK(whole.answer(p) == serial_answer(p));
    CHECK((cut_off == serial_answer(p)) == (workloads()[w].traffic == Traffic::silent));
  }
}

TEST_CASE("every workload has the serial answer under every strategy and cut", "[lb_lab]") {
  Settings s = small();
  s.strategies = {"all"};
  const Sweep sweep = sweep_on("pes=4,cost=1us", s);
  CHECK(sweep.wrong.empty());
  REQUIRE(sweep.rows.size() == workloads().size() * 3 * 12);
  std::map<std::string, std::uint64_t> answers;
  for (const Row& row : sweep.rows) {
    INFO(row.workload << " " << row.per_pe << " " << row.strategy);
    CHECK(answers.try_emplace(row.workload, row.answer).first->second == row.answer);
  }
  CHECK(answers.size() == workloads().size());
}

TEST_CASE("under any schedule and forced migrations the answer is the serial one, balanced or not",
          "[lb_lab]") {
  for (int seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    Settings s = small();
    s.workloads = {"moving_hot_spot", "random_walk_comm", "stencil", "collision", "particles"};
    s.per_pe = {1, 3};
    s.when = std::array{"at_sync", "periodic", "automatic"}[static_cast<std::size_t>(seed) % 3];
    s.strategies = {"rotate", "greedy", "graph", "gossip"};
    const double chance = seed <= 3 ? 0.1 : 0;
    const Sweep sweep =
        sweep_on(fmt::format("pes=5,cost=100ns,seed={},migrate={}", seed, chance), s);
    CHECK(sweep.wrong == "");
    CHECK(sweep.rows.size() == 5 * 2 * 5);
  }
}
