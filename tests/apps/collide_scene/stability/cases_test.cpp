// The stability report, and that it would notice a wrong answer.
#include "apps/collide_scene/stability/cases.hpp"

#include "tests/support/catch.hpp"

using namespace collide_scene;

TEST_CASE("the report counts lost, doubled and added pairs", "[apps][collide_scene]") {
  const std::vector<ScenePair> expected{{0, 1}, {0, 2}, {3, 7}};
  CHECK(difference(expected, {{3, 7}, {0, 2}, {0, 1}}) == Difference{});
  CHECK(difference(expected, {{3, 7}, {0, 1}}) == Difference{1, 0, 0});
  CHECK(difference(expected, {{3, 7}, {0, 1}, {3, 7}, {0, 2}, {3, 7}}) == Difference{0, 2, 0});
  CHECK(difference(expected, {{3, 7}, {0, 1}, {0, 2}, {1, 3}}) == Difference{0, 0, 1});
  CHECK(difference(expected, {}) == Difference{3, 0, 0});
  CHECK(difference({}, {{1, 2}, {1, 2}}) == Difference{0, 1, 1});
}

TEST_CASE("every extreme scene gives the pairs of brute force", "[apps][collide_scene]") {
  const std::vector<StabilityCase> rows = stability_cases();
  CHECK(rows.size() > 150);
  std::uint64_t n_pairs = 0;
  for (const StabilityCase& row : rows) {
    INFO(row.name << " " << row.parameter << " " << row.value.value_or(0) << ": " << row.lost
                  << " lost, " << row.doubled << " doubled, " << row.added << " added, "
                  << row.seconds << " s " << row.note);
    CHECK(row.ok);
    n_pairs += row.n_pairs;
  }
  CHECK(n_pairs > 1'000'000);
}

TEST_CASE("scenes with a known number of pairs have it", "[apps][collide_scene]") {
  std::size_t n_seen = 0;
  for (const StabilityCase& row : stability_cases()) {
    const auto has = [&](const char* name, std::uint64_t n) {
      if (row.name != name) return;
      ++n_seen;
      CHECK(row.n_pairs == n);
    };
    has("identical boxes", 1000 * 999 / 2);
    has("identical triangles", 300 * 299 / 2);
    has("cubes face to face, open", 0);
    has("cubes face to face", 8 * 8 * 7 * 3 + 8 * 7 * 7 * 6 + 7 * 7 * 7 * 4);
    has("crossing segments, exact", 200 * 200);
    has("nested L shapes, exact", 0);
  }
  CHECK(n_seen == 2 + 4 + 4 + 2);
}
