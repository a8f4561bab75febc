// Snapshots on another number of PEs.
#include "runtime/balance/fold.hpp"

#include "apps/bench/balance_scenes.hpp"
#include "runtime/balance/metrics.hpp"
#include "tests/support/catch.hpp"

using namespace tess;
using namespace tess::balance;

namespace {

std::vector<int> pes_of(const Snapshot& s) {
  std::vector<int> result;
  for (const PeId pe : s.elements.pe) result.push_back(pe.value);
  return result;
}

Snapshot one_on_each(std::size_t n_pes) {
  Snapshot s = idle_pes(n_pes);
  for (std::size_t pe = 0; pe < n_pes; ++pe) add_element(s, pe, 1 + static_cast<double>(pe));
  return s;
}

}  // namespace

TEST_CASE("a snapshot on fewer PEs keeps neighbours together or deals them out",
          "[balance][fold]") {
  CHECK(pes_of(fold(one_on_each(6), 3, Fold::block)) == std::vector{0, 0, 1, 1, 2, 2});
  CHECK(pes_of(fold(one_on_each(6), 3, Fold::modulo)) == std::vector{0, 1, 2, 0, 1, 2});
  CHECK(pes_of(fold(one_on_each(5), 2, Fold::block)) == std::vector{0, 0, 0, 1, 1});
  CHECK(pes_of(fold(one_on_each(3), 7, Fold::block)) == std::vector{0, 2, 4});
  CHECK(pes_of(fold(one_on_each(3), 7, Fold::modulo)) == std::vector{0, 1, 2});
}

TEST_CASE("folding moves elements and changes nothing else of them", "[balance][fold]") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    const Snapshot before = anything(seed);
    for (const Fold how : {Fold::block, Fold::modulo}) {
      for (std::size_t n_pes = 1; n_pes < 12; ++n_pes) {
        const Snapshot after = fold(before, n_pes, how);
        validate(after);
        REQUIRE(after.pes.size() == n_pes);
        REQUIRE(after.elements.key == before.elements.key);
        REQUIRE(after.elements.load == before.elements.load);
        REQUIRE(after.elements.migratable == before.elements.migratable);
        REQUIRE(after.edges == before.edges);
        if (n_pes == 1) {
          REQUIRE(measure(after, after.elements.pe).external_bytes == 0);
        }
        if (n_pes == before.pes.size()) {
          REQUIRE(pes_of(after) == pes_of(before));
          REQUIRE(after.pes.speed == before.pes.speed);
        }
      }
    }
  }
}

TEST_CASE("a fold that is none is named", "[balance][fold]") {
  CHECK(parse_fold("block") == Fold::block);
  CHECK(parse_fold("modulo") == Fold::modulo);
  CHECK_THROWS_WITH(parse_fold("half"), Catch::Contains("half") && Catch::Contains("modulo"));
}
