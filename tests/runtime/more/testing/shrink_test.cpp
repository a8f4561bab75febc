// The shrinking of a set of decisions, without a run.
#include "runtime/more/testing/shrink.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/more/testing/trial.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <numeric>

using namespace tess::test::detail;

namespace {

DecisionIds first_numbers(std::size_t n) {
  DecisionIds all(n);
  std::iota(all.begin(), all.end(), DecisionId{0});
  return all;
}

bool has_all(const DecisionIds& some, const DecisionIds& wanted) {
  return std::includes(some.begin(), some.end(), wanted.begin(), wanted.end());
}

}  // namespace

TEST_CASE("shrinking finds the decisions that a failure needs", "[runtime][testing][unit]") {
  tess::Random random(1);
  for (int round = 0; round < 200; ++round) {
    const std::size_t n = 1 + random.below(300);
    DecisionIds needed;
    for (std::uint64_t k = random.below(5); k > 0; --k)
      needed.push_back(static_cast<DecisionId>(random.below(n)));
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    unsigned n_runs = 0;
    const auto fails = [&](const DecisionIds& some) -> std::optional<DecisionIds> {
      ++n_runs;
      if (!has_all(some, needed)) return std::nullopt;
      return some;
    };
    INFO(n << " decisions, of which " << needed.size() << " are needed");
    const Shrunk shrunk = shrink(first_numbers(n), fails, 2000);
    CHECK(shrunk.kept == needed);
    CHECK(shrunk.is_minimal);
    CHECK(shrunk.n_tries == n_runs);
  }
}

TEST_CASE("a shrunk set fails, and no longer without any one decision",
          "[runtime][testing][unit]") {
  // Two of three decisions are enough, in several ways, and one spoils the failure.
  const auto is_failing = [](const DecisionIds& some) {
    const auto has = [&](DecisionId id) {
      return std::binary_search(some.begin(), some.end(), id);
    };
    const int n = int{has(7)} + int{has(40)} + int{has(41)};
    return n >= 2 && (!has(13) || has(60));
  };
  const auto fails = [&](const DecisionIds& some) -> std::optional<DecisionIds> {
    if (!is_failing(some)) return std::nullopt;
    return some;
  };
  const Shrunk shrunk = shrink(first_numbers(64), fails, 1000);
  REQUIRE(is_failing(shrunk.kept));
  CHECK(shrunk.kept.size() == 2);
  for (const DecisionId one : shrunk.kept) {
    DecisionIds fewer = shrunk.kept;
    std::erase(fewer, one);
    CHECK_FALSE(is_failing(fewer));
  }
}

TEST_CASE("decisions that do not come up are dropped, and tries are bounded",
          "[runtime][testing][unit]") {
  const auto only_small = [](const DecisionIds& some) -> std::optional<DecisionIds> {
    if (!has_all(some, {3, 5, 9})) return std::nullopt;
    DecisionIds came_up = some;
    std::erase_if(came_up, [](DecisionId id) { return id >= 16; });
    return came_up;
  };
  const Shrunk shrunk = shrink(first_numbers(100'000), only_small, 200);
  CHECK(shrunk.kept == DecisionIds{3, 5, 9});
  CHECK(shrunk.is_minimal);
  const Shrunk stopped = shrink(first_numbers(1000), only_small, 3);
  CHECK(stopped.n_tries == 3);
  CHECK_FALSE(stopped.is_minimal);
  CHECK(has_all(stopped.kept, {3, 5, 9}));
}

TEST_CASE("the text that repeats a run is read back, and a wrong one is refused by name",
          "[runtime][testing][unit]") {
  for (const Repeat& one : {Repeat{17, std::nullopt}, Repeat{17, DecisionIds{}},
                            Repeat{~std::uint64_t{0}, DecisionIds{0x12, 0xffffffff}}}) {
    const Repeat back = parse_repeat(repeat_text(one));
    CHECK(back.seed == one.seed);
    CHECK(back.keep == one.keep);
  }
  CHECK(repeat_text({17, DecisionIds{18, 0x2f61b6e8}}) == "seed=17,keep=00000012,2f61b6e8");
  CHECK(repeat_text({17, DecisionIds{}}) == "seed=17,keep=none");
  for (const char* wrong : {"17", "seed=", "seed=x", "seed=1,kept=2", "seed=1,keep=",
                            "seed=1,keep=g", "seed=1,keep=1,,2", "seed=1,keep=123456789"}) {
    INFO(wrong);
    CHECK_THROWS_AS(parse_repeat(wrong), tess::Error);
  }
}
