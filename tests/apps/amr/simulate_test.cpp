// The oct-tree of chares, under any schedule.
#include "apps/amr/simulate.hpp"

#include "tests/support/adversarial.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

using namespace amr;

namespace {

Settings small(std::int32_t least_level, std::int32_t most_level) {
  Settings settings{.problem = {}, .change_every = 2, .balance = {}, .checkpoints = {}};
  Problem& problem = settings.problem;
  problem.n_cells = 4;
  problem.least_level = least_level;
  problem.most_level = most_level;
  problem.width = 0.1;
  problem.n_steps = 8;
  problem.complete();
  return settings;
}

Outcome run(Settings settings, int n_pes, std::uint64_t seed) {
  tess::Setup setup = tess::test::adversarial(n_pes, seed);
  Outcome outcome;
  const int code = tess::run(setup, [&] { return simulate(settings, outcome); });
  CHECK(code == 0);
  CHECK(outcome.end.norms.mass == outcome.mass_at_start);
  double volume = 0;  // the leaves cover the cube once
  for (std::size_t level = 0; level < outcome.end.of_level.size(); ++level)
    volume +=
        static_cast<double>(outcome.end.of_level[level]) / static_cast<double>(1ULL << 3 * level);
  CHECK(volume == 1);
  CHECK(outcome.n_created - outcome.n_destroyed == outcome.end.n_blocks);
  return outcome;
}

}  // namespace

TEST_CASE("tree, field and mass do not depend on schedule, PEs or balancing", "[apps][amr]") {
  Settings settings = small(1, 3);
  const Outcome want = run(settings, 1, 1);
  CHECK(want.n_destroyed > 0);
  CHECK(want.end.of_level[2] > 0);
  CHECK(want.end.of_level[3] > 0);
  CHECK(want.l1() > 0);
  CHECK(want.l1() < 0.01);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    settings.balance.reset();
    if (seed % 2 == 0) settings.balance = tess::BalanceOptions{.strategy = "random", .seed = seed};
    const Outcome got = run(settings, 2 + static_cast<int>(seed % 4), seed);
    CHECK(got.end.norms.hash == want.end.norms.hash);
    CHECK(got.end.n_blocks == want.end.n_blocks);
    CHECK(got.n_created == want.n_created);
    CHECK(got.l1() == want.l1());
    if (settings.balance) CHECK(got.n_moved > 0);
  }
}

TEST_CASE("a tree that is refined everywhere has the bits of a uniform one", "[apps][amr]") {
  Settings refined = small(0, 2);
  refined.problem.width = 0.25;
  refined.problem.refine = 1e-9;
  const Outcome want = run(small(2, 2), 1, 3);
  Settings uniform = small(2, 2);
  uniform.problem.width = 0.25;
  CHECK(run(refined, 3, 3).end.norms.hash == run(uniform, 4, 5).end.norms.hash);
  CHECK(run(refined, 3, 3).end.norms.hash != want.end.norms.hash);  // of another width
}

TEST_CASE("a field that smears out takes its tree down with it", "[apps][amr]") {
  Settings settings = small(1, 4);
  Problem& problem = settings.problem;
  problem.order = 1;
  problem.width = 0.05;
  problem.refine = 0.03;
  problem.n_steps = 160;
  problem.complete();
  const Outcome outcome = run(settings, 3, 1);
  CHECK(outcome.most_blocks > 50);
  CHECK(outcome.end.n_blocks < 50);
}

TEST_CASE("errors fall with the level of the tree and with the order", "[apps][amr]") {
  const auto error = [](std::int32_t order, std::int32_t level) {
    Settings settings = small(2, level);
    Problem& problem = settings.problem;
    problem.n_cells = 6;
    problem.order = order;
    problem.width = 0.12;
    problem.refine = 0.04 / (1 << 2 * (level - 2));
    problem.n_steps = 0;
    problem.end = 0.1;
    problem.complete();
    return run(settings, 2, 1).l1();
  };
  const double first = error(1, 2), second = error(2, 2), third = error(3, 2);
  CHECK(second < first / 2);
  CHECK(third < second);
  CHECK(error(2, 3) < second / 3);
}

TEST_CASE("where messages have a fixed cost, cells have one", "[apps][amr]") {
  Settings settings = small(0, 0);
  settings.problem.n_cells = 32;
  settings.problem.n_steps = 4;
  settings.problem.complete();
  Outcome outcome;
  CHECK(tests::run("pes=1,cost=1ns", [&] { return simulate(settings, outcome); }).exit_code == 0);
  CHECK(outcome.seconds / static_cast<double>(outcome.cell_steps) == Approx(30e-9).epsilon(0.1));
}

TEST_CASE("a field as wide as the cube is smooth at its border", "[apps][amr]") {
  const auto error = [](std::int32_t level) {
    Settings settings = small(level, level);
    Problem& problem = settings.problem;
    problem.order = 3;
    problem.width = 0.7;
    problem.n_steps = 0;
    problem.end = 0.1;
    problem.complete();
    return run(settings, 2, 1).l1();
  };
  const double first = error(1), second = error(2), third = error(3);
  CHECK(second < first / 6);
  CHECK(third < second / 6);
}
