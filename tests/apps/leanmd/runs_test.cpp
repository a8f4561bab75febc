// Runs on the simulated machine in adversarial order, with forced migration and balancing: one
// result.
#include "apps/leanmd/report.hpp"
#include "apps/leanmd/stability.hpp"
#include "apps/leanmd/study.hpp"
#include "tests/support/adversarial.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

using namespace leanmd;

namespace {

constexpr InitialState start{.n_atoms = 80, .edge = 6.5, .gradient = 1, .temperature = 2};

Options small(std::array<std::int32_t, 3> cells) {
  Options options;
  options.problem.box = {start.edge, cells};
  options.problem.cutoff = 2;
  options.problem.every = 4;
  options.problem.exchange_every = 3;
  options.n_steps = 12;
  options.check = options.reverse = true;
  return options;
}

Outcome run(Options options, int n_pes, std::uint64_t seed) {
  tess::Setup setup = tess::test::adversarial(n_pes, seed);
  Outcome outcome;
  const Motion motion(start.edge, options.problem.dt);
  REQUIRE(tess::run(setup,
                    [&] { return simulate(options, initial_atoms(start, motion), outcome); }) == 0);
  return outcome;
}

}  // namespace

TEST_CASE("the result is the same for any cells, PEs, schedules and migrations", "[leanmd]") {
  const Outcome expected = run(small({1, 1, 1}), 1, 0);
  REQUIRE(expected.error.empty());
  REQUIRE(expected.wrong_forces == 0);
  REQUIRE(expected.hash != expected.first_hash);
  std::int64_t most_change = 0, most_kinetic = 0;
  for (const Vector& one : expected.energies) {
    most_change = std::max(most_change, std::abs(one[2] - expected.energies.front()[2]));
    most_kinetic = std::max(most_kinetic, one[0]);
  }
  CHECK(expected.most_change == most_change);
  CHECK(expected.most_kinetic == most_kinetic);
  std::uint64_t seed = 0;
  for (const std::array<std::int32_t, 3> cells :
       {std::array{2, 2, 2}, std::array{1, 4, 2}, std::array{3, 3, 3}}) {
    for (const char* strategy : {"", "random", "greedy_refine,when=automatic", "diffusion"}) {
      INFO("seed " << ++seed << ", strategy " << strategy);
      Options options = small(cells);
      if (*strategy != '\0') options.balance = tess::parse_balance(strategy);
      const Outcome outcome = run(options, 1 + static_cast<int>(seed % 7), seed);
      CHECK(outcome.error.empty());
      CHECK(outcome.hash == expected.hash);
      CHECK(outcome.energies == expected.energies);
      CHECK(outcome.n_atoms == expected.n_atoms);
      if (options.balance && options.balance->when == tess::BalanceWhen::at_sync)
        CHECK_FALSE(outcome.rounds.empty());
    }
  }
}

TEST_CASE("pairs that no compute sees are found", "[leanmd]") {
  Options options = small({5, 5, 5});
  options.problem.cutoff = 3;
  options.problem.skin = -2;  // so a cell of edge 1.3 reaches only the next one
  const Outcome outcome = run(options, 3, 1);
  INFO(outcome.error);
  CHECK(outcome.wrong_forces > 0);
  CHECK_THAT(outcome.error, Contains("differ from those of all pairs"));
  CHECK(outcome.is_wrong);
}

TEST_CASE("a run that cannot continue says why, and ends early", "[leanmd]") {
  Options options = small({2, 2, 2});
  options.n_steps = 1000;
  options.problem.dt = 0.2;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Outcome outcome = run(options, 4, seed);
    CHECK(outcome.error.find("step 1, atom ") == 0);
    CHECK_FALSE(outcome.is_wrong);
    CHECK(outcome.energies.size() == 1);
    CHECK_THAT(table(options, outcome), Contains(" cells, 0 steps: "));
    CHECK(outcome.error == run(options, 1, 0).error);
  }
}

TEST_CASE("extreme simulations run well or are refused", "[leanmd]") {
  kit::Cases<> report;
  REQUIRE(tests::run("pes=2", [&] { return stability_report(report); }).exit_code == 0);
  CHECK(report.rows().size() >= 20);
  CHECK(report.n_failed() == 0);
}

TEST_CASE("the energy drift is of second order in the time step", "[leanmd]") {
  Options options = small({2, 2, 2});
  options.check = options.reverse = false;
  tess::Setup setup = tess::test::adversarial(3, 4);
  std::vector<StudyRow> rows;
  REQUIRE(tess::run(setup, [&] { return study(options, start, rows); }) == 0);
  REQUIRE(rows.size() == 5);
  CHECK(fitted_order(rows).value() == Approx(2).margin(0.1));
}

TEST_CASE("a study marks wrong results, and has no order without two rows", "[leanmd]") {
  Options options = small({5, 5, 5});
  options.problem.cutoff = 3;
  options.problem.skin = -2;  // so a cell of edge 1.3 reaches only the next one
  tess::Setup setup = tess::test::adversarial(3, 4);
  std::vector<StudyRow> rows;
  REQUIRE(tess::run(setup, [&] { return study(options, start, rows); }) == 0);
  REQUIRE(rows.size() == 5);
  for (const StudyRow& row : rows) CHECK(row.is_wrong);
  CHECK_FALSE(fitted_order(rows));
  CHECK(study_rows().json(rows).members().front().value.at("energy_drift").kind() ==
        kit::Json::Kind::null);
}
