// The search of nqueens in messages, under any schedule.
#include "apps/nqueens/search.hpp"

#include "tests/support/adversarial.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

using namespace nqueens;

namespace {

Outcome run(const Problem& problem, int n_pes, std::uint64_t seed) {
  tess::Setup setup = tess::test::adversarial(n_pes, seed);
  Outcome outcome;
  const int code = tess::run(setup, [&] { return search(problem, outcome); });
  CHECK(code == 0);
  return outcome;
}

}  // namespace

TEST_CASE("counts and boards do not depend on schedule, form, grain or priority",
          "[apps][nqueens]") {
  const Outcome want = run({.n = 8, .grain = 8}, 1, 1);
  CHECK(want.count.n_solutions == known_count(8));
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (const Form form : {Form::group, Form::chares})
      for (const std::int32_t grain : {7, 5, 3}) {
        CAPTURE(seed, grain, form == Form::group);
        const Outcome got =
            run({.n = 8, .grain = grain, .prioritised = seed % 2 == 0, .form = form}, 5, seed);
        CHECK(got.count.n_solutions == want.count.n_solutions);
        CHECK(got.count.n_boards == want.count.n_boards);
        CHECK(got.hash == want.hash);
      }
}

TEST_CASE("the first solution is the leftmost one under any schedule", "[apps][nqueens]") {
  for (const std::int32_t n : {3, 8, 10}) {
    std::uint64_t n_boards = 0;
    const auto want = first_below(Board(), n, n_boards);
    for (std::uint64_t seed = 1; seed <= 12; ++seed)
      for (const Form form : {Form::group, Form::chares}) {
        CAPTURE(n, seed, form == Form::group);
        const Outcome got =
            run({.n = n, .grain = n - 2, .first = true, .prioritised = seed % 2 == 0, .form = form},
                4, seed);
        CHECK(got.found == want.has_value());
        if (want) CHECK(got.solution == *want);
      }
  }
}

TEST_CASE("where messages have a fixed cost, boards have one", "[apps][nqueens]") {
  const auto seconds = [](std::int32_t n, bool first) {
    Outcome outcome;
    const auto main = [&] { return search({.n = n, .grain = n, .first = first}, outcome); };
    CHECK(tests::run("pes=1,cost=100ns", main).exit_code == 0);
    CHECK(outcome.n_tasks == 1);
    return outcome.seconds / static_cast<double>(outcome.count.n_boards);
  };
  CHECK(seconds(10, false) == Approx(6e-9).epsilon(0.1));
  CHECK(seconds(16, true) == Approx(6e-9).epsilon(0.1));
}

TEST_CASE("with priorities one PE looks at few boards that one serial search would not",
          "[apps][nqueens]") {
  std::uint64_t serial = 0;
  (void)first_below(Board(), 12, serial);
  const auto boards = [](bool prioritised) {
    Outcome outcome;
    const auto main = [&] {
      return search({.n = 12, .grain = 7, .first = true, .prioritised = prioritised}, outcome);
    };
    CHECK(tests::run("pes=1,cost=100ns", main).exit_code == 0);
    return outcome;
  };
  const Outcome with = boards(true), without = boards(false);
  CHECK(with.count.n_boards <= serial + 5);
  CHECK(with.n_tasks < 100);
  CHECK(without.n_tasks > 100 * with.n_tasks);
}
