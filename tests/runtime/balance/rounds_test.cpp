// The coordinator's decisions, from reports only and without the runtime.
#include "runtime/balance/rounds/coordinator.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <string>

namespace {

using namespace tess;
using namespace tess::balance;

/// PEs with elements of these loads; element keys are 100 · (its first PE) + position there.
class Phases {
 public:
  explicit Phases(std::vector<std::vector<double>> loads) {
    for (std::size_t pe = 0; pe < loads.size(); ++pe) {
      PeReport report;
      for (std::size_t i = 0; i < loads[pe].size(); ++i) {
        report.keys.push_back({CollectionId{7}, 100 * pe + i});
        report.loads.push_back(loads[pe][i]);
        report.migratable.push_back(1);
        report.size_bytes.push_back(10);
      }
      reports.push_back(std::move(report));
    }
  }
  void move(const std::vector<std::vector<Move>>& moves) {
    std::vector<PeReport> next(reports.size());
    for (std::size_t pe = 0; pe < reports.size(); ++pe) {
      for (std::size_t i = 0; i < reports[pe].keys.size(); ++i) {
        std::size_t to = pe;
        for (const Move& one : moves[pe])
          if (one.element == i) to = slot(one.to);
        next[to].keys.push_back(reports[pe].keys[i]);
        next[to].loads.push_back(reports[pe].loads[i]);
        next[to].migratable.push_back(1);
        next[to].size_bytes.push_back(10);
      }
    }
    reports = std::move(next);
  }
  void set_load(std::uint64_t element, double seconds) {
    for (PeReport& report : reports)
      for (std::size_t i = 0; i < report.keys.size(); ++i)
        if (report.keys[i].element == element) report.loads[i] = seconds;
  }
  [[nodiscard]] std::size_t pe_of(std::uint64_t element) const {
    for (std::size_t pe = 0; pe < reports.size(); ++pe)
      for (const ElementKey& key : reports[pe].keys)
        if (key.element == element) return pe;
    return reports.size();
  }
  [[nodiscard]] PhaseSums sums() const {
    PhaseSums all;
    for (const PeReport& report : reports) {
      double seconds = report.background;
      for (const Load one : report.loads) seconds += one.seconds();
      all = MergeSums()(all, {seconds, seconds, 1, seconds, report.loads.size(), 0});
    }
    return all;
  }
  std::vector<PeReport> reports;
};

std::size_t count(const std::vector<std::vector<Move>>& moves) {
  std::size_t n = 0;
  for (const auto& of_pe : moves) n += of_pe.size();
  return n;
}

BalanceOptions automatic() {
  BalanceOptions options;
  options.strategy = "greedy";
  options.when = BalanceWhen::automatic;
  return options;
}

std::string message_of(const char* text) {
  try {
    (void)parse_balance(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a round tells what the one before gained, against the same phase without its moves",
          "[balance][rounds]") {
  Phases phases({{1, 1, 1, 1}, {}});
  BalanceOptions options;
  options.strategy = "refine";
  Coordinator coordinator(options, {});
  const auto moves = coordinator.decide(phases.reports);
  CHECK(count(moves) == 2);
  phases.move(moves);
  coordinator.finish(1e-3, 1);
  CHECK(coordinator.history().at(0).before == Approx(2));
  CHECK(coordinator.history().at(0).predicted == Approx(1));
  CHECK(coordinator.history().at(0).moved_bytes == 20);
  CHECK(count(coordinator.decide(phases.reports)) == 0);
  CHECK(coordinator.history().at(0).measured == Approx(1));
  CHECK(coordinator.history().at(0).gain == Approx(0.5));
}

TEST_CASE("a round moves nothing while no load is known, and counts unknown ones as the mean",
          "[balance][rounds]") {
  Phases phases({{3, 3, 0, 0}, {}});
  BalanceOptions options;
  options.strategy = "greedy";
  phases.reports[0].loads.assign(4, Load::unknown());
  Coordinator blind(options, {});
  CHECK(count(blind.decide(phases.reports)) == 0);
  CHECK(blind.history().at(0).skipped);
  CHECK(blind.history().at(0).n_unknown == 4);

  phases.reports[0].loads = {3, 3, Load::unknown(), Load::unknown()};
  Coordinator coordinator(options, {});
  const auto moves = coordinator.decide(phases.reports);
  CHECK(coordinator.history().at(0).before == Approx(2));  // 12 s of work, all on the first
  CHECK(coordinator.history().at(0).predicted == Approx(1));
  for (const Move& one : moves[0]) CHECK(one.element < 2);
  CHECK(count(moves) == 2);
}

TEST_CASE("the user's strategy sees unknown loads as unknown", "[balance][rounds]") {
  Phases phases({{3, 0, 0}, {}});
  phases.reports[0].loads[2] = Load::unknown();
  Coordinator coordinator({}, [&](const Snapshot& s) {
    CHECK(s.elements.load == phases.reports[0].loads);
    return Assignment(3, PeId{s.elements.load[2].seconds() > 0 ? 1 : 0});
  });
  CHECK_THROWS_WITH(coordinator.decide(phases.reports), Catch::Contains("an unknown load"));
}

TEST_CASE("an automatic round waits until a load is known", "[balance][rounds]") {
  Coordinator coordinator(automatic(), {});
  CHECK_FALSE(coordinator.worth({5, 5, 2, 0, 0, 10}));
  CHECK(coordinator.worth({5, 5, 2, 5, 1, 0}));
}

TEST_CASE("the imbalance of a phase compares known loads with their average", "[balance][rounds]") {
  const PhaseSums sums{5, 20, 4, 20, 15, 1};  // 4 PEs of 5 s, and one element that has not run
  CHECK(sums.max_over_average() == Approx(1));
  CHECK(sums.average_time() > 5);
}

TEST_CASE("a round that is undone leaves the imbalance of the placement that comes back",
          "[balance][rounds]") {
  Phases phases({{4, 4}, {1, 1}});
  Coordinator coordinator(automatic(), {});
  REQUIRE(coordinator.worth(phases.sums()));
  const auto moves = coordinator.decide(phases.reports);
  REQUIRE(count(moves) != 0);
  phases.move(moves);
  coordinator.finish(0.5, 8);
  // Now the loads turn, so that the placement before would have been even: 10 s on each.
  REQUIRE(phases.pe_of(0) != phases.pe_of(1));
  for (const std::uint64_t element : {0U, 1U, 100U, 101U})
    phases.set_load(element, phases.pe_of(element) == phases.pe_of(0) ? 9 : 1);
  REQUIRE(coordinator.worth(phases.sums()));
  const auto back = coordinator.decide(phases.reports);
  phases.move(back);
  coordinator.finish(0.5, 8);
  REQUIRE(coordinator.history().back().rolled_back);
  Phases worse({{3, 3}, {1, 1}});  // loses 2 s a phase against an even placement
  int n_phases = 0;
  while (!coordinator.worth(worse.sums())) REQUIRE(++n_phases < 20);
}

TEST_CASE("a prediction leaves out phases in which a load was not known", "[balance][rounds]") {
  Phases phases(std::vector<std::vector<double>>{{5}});
  Predictor predictor(Prediction::moving_average);
  phases.reports[0].loads = {Load::unknown()};
  const Snapshot unknown = snapshot_of(phases.reports, {});
  CHECK_FALSE(unknown.elements.load[0].is_known());
  predictor.record(unknown);
  CHECK(predictor.n_known() == 0);
  phases.reports[0].loads = {5};
  predictor.record(snapshot_of(phases.reports, {}));
  CHECK(predictor.predict(unknown).elements.load[0].seconds() == Approx(5));
}

TEST_CASE("automatic waits until what imbalance lost is what a round costs", "[balance][rounds]") {
  Phases phases({{3, 3}, {2, 2}});  // slowest 6, average 5
  Coordinator coordinator(automatic(), {});
  REQUIRE(coordinator.worth(phases.sums()));  // nothing is known of the cost yet
  (void)coordinator.decide(phases.reports);
  coordinator.finish(10, 6);  // expensive: 10 s
  // Judging the round takes one collection; after it nothing was lost yet.
  if (coordinator.history().back().n_moved != 0) {
    REQUIRE(coordinator.worth(phases.sums()));
    (void)coordinator.decide(phases.reports);
    coordinator.finish(0.1, 6);
  }
  // The floor is what that round left: now a phase that loses 3 s more than that.
  Phases worse({{9, 4}, {1, 1}});  // slowest 13, average 7.5
  int n_phases = 0;
  while (!coordinator.worth(worse.sums())) REQUIRE(++n_phases < 100);
  CHECK(n_phases >= 1);
  CHECK(n_phases <= 5);
}

TEST_CASE("automatic does not ask for rounds in vain", "[balance][rounds]") {
  Phases phases({{10}, {1}});  // one element is the imbalance: nothing helps
  Coordinator coordinator(automatic(), {});
  int n_rounds = 0;
  for (int phase = 0; phase < 200; ++phase) {
    if (!coordinator.worth(phases.sums())) continue;
    ++n_rounds;
    CHECK(count(coordinator.decide(phases.reports)) == 0);
    coordinator.finish(20, 10);
  }
  // 4.4 s are lost a phase, of which a tenth counts: a round of 20 s each 45 phases.
  CHECK(n_rounds >= 2);
  CHECK(n_rounds <= 8);
}

TEST_CASE("automatic undoes a round that made it worse", "[balance][rounds]") {
  Phases phases({{4, 4}, {1, 1}});
  Coordinator coordinator(automatic(), {});
  REQUIRE(coordinator.worth(phases.sums()));
  const auto moves = coordinator.decide(phases.reports);
  REQUIRE(count(moves) > 0);
  coordinator.finish(1e-3, 8);
  const Phases before = phases;
  phases.move(moves);
  // The loads turn: what the round brought together on PE 1 is heavy, what it took away light.
  for (const std::uint64_t element : {0U, 1U, 100U, 101U})
    phases.set_load(element, phases.pe_of(element) == 1 ? 9 : 1);
  const PhaseSums now = phases.sums();
  REQUIRE(coordinator.worth(now));
  const auto back = coordinator.decide(phases.reports);
  const Round& round = coordinator.history().back();
  REQUIRE(coordinator.history().at(0).gain < -0.01);
  REQUIRE(round.rolled_back);
  phases.move(back);
  for (const std::uint64_t element : {0U, 1U, 100U, 101U})
    CHECK(phases.pe_of(element) == before.pe_of(element));
}

TEST_CASE("automatic runs ever fewer rounds while loads do not persist", "[balance][rounds]") {
  // Each phase the heavy elements are those that share a PE, wherever a round has put them.
  Phases phases({{9, 9}, {1, 1}});
  Coordinator coordinator(automatic(), {});
  int n_searches = 0;
  constexpr int n_phases = 400;
  for (int phase = 0; phase < n_phases; ++phase) {
    const std::size_t heavy = phases.pe_of(phase % 2 == 0 ? 0U : 100U);
    for (const std::uint64_t element : {0U, 1U, 100U, 101U})
      phases.set_load(element, phases.pe_of(element) == heavy ? 9 : 1);
    if (!coordinator.worth(phases.sums())) continue;
    phases.move(coordinator.decide(phases.reports));
    const Round& round = coordinator.finish(1e-3, 9);
    if (round.n_moved != 0 && !round.rolled_back) ++n_searches;
  }
  CHECK(n_searches >= 2);
  CHECK(n_searches <= 12);  // about log2 of the phases
}

TEST_CASE("automatic weighs the cost of a distributed round", "[balance][rounds]") {
  BalanceOptions options = automatic();
  options.strategy = "gossip";
  Coordinator coordinator(options, {});
  int n_rounds = 0;
  for (int phase = 0; phase < 40; ++phase) {
    // On two PEs with 10 s of work: 0.5 s are lost in each phase, and a round takes 2 s.
    if (!coordinator.worth({5.5, 10, 2, 10, 8, 0})) continue;
    ++n_rounds;
    Round round;
    round.before = 1.2;
    round.predicted = 1;
    round.n_moved = 2;
    coordinator.record_distributed(round);
    coordinator.finish(2, 5);
  }
  CHECK(n_rounds >= 5);
  CHECK(n_rounds <= 10);
  CHECK(coordinator.history().at(0).measured == Approx(1.1));  // of the next phase
}

TEST_CASE("a history names the user's strategy as the user does", "[balance][rounds]") {
  const auto name = [](const std::string& given) {
    BalanceOptions options;
    options.strategy = given;
    Phases phases({{1, 2}, {3}});
    Coordinator coordinator(options, [](const Snapshot& s) { return s.elements.pe; });
    (void)coordinator.decide(phases.reports);
    return coordinator.history().at(0).strategy;
  };
  CHECK(name("by_column") == "by_column");
  CHECK(name(BalanceOptions().strategy) == "own");  // never the name of a built-in strategy
}

TEST_CASE("a report names elements in one snapshot; parcels to strangers are left out",
          "[balance][rounds]") {
  Phases phases({{1, 2}, {3}});
  phases.reports[0].parcels = {{1, {CollectionId{7}, 100}, 50, 2},
                               {0, {CollectionId{8}, 100}, 60, 1}};
  phases.reports[0].positions = {{1, 2, 3}, {4, 5, 6}};
  BalanceOptions options;
  options.speeds = {2, 1};
  const Snapshot s = snapshot_of(phases.reports, options);
  CHECK(s.elements.load == std::vector<Load>{1, 2, 3});
  CHECK(s.pes.speed == options.speeds);
  REQUIRE(s.edges.size() == 1);
  CHECK(s.edges[0] == balance::Edge{1, 2, 50, 2});
  CHECK(s.elements.position.empty());  // one PE gave none: a strategy needs all
}

TEST_CASE("balance options in one line of text", "[balance][rounds]") {
  const BalanceOptions options = parse_balance(
      "refine,when=periodic,period=2.5ms,prediction=linear_trend,window=3,seed=9,report");
  CHECK(options.strategy == "refine");
  CHECK(options.when == BalanceWhen::periodic);
  CHECK(options.period == std::chrono::microseconds(2500));
  CHECK(options.prediction == "linear_trend");
  CHECK(options.window == 3);
  CHECK(options.seed == 9);
  CHECK(options.lines == RoundLines::print);
  CHECK(message_of("gredy").find("no balance strategy 'gredy'") != std::string::npos);
  CHECK(message_of("greedy,when=later").find("later is not one of at_sync") != std::string::npos);
  CHECK(message_of("greedy,when=periodic").find("period") != std::string::npos);
  CHECK(message_of("greedy,period=5").find("5 is not a time") != std::string::npos);
  CHECK(message_of("greedy,period=1e10s").find("1e10s is not a time") != std::string::npos);
  CHECK(message_of("greedy,period=infs").find("infs is not a time") != std::string::npos);
  CHECK(message_of("greedy,period=5ms").find("is for when=periodic") != std::string::npos);
  CHECK(message_of("greedy,strategy=refine").find("strategy is given twice") != std::string::npos);
  CHECK(message_of("").find("is empty") != std::string::npos);
  CHECK(message_of("greedy,report=off").find("unknown key report=off") != std::string::npos);
  CHECK(message_of("greedy,window=0").find("window") != std::string::npos);
  CHECK(message_of("greedy,often").find("unknown key often") != std::string::npos);
  CHECK(
      message_of("gossip,prediction=linear_trend") ==
      "balance prediction: linear_trend, but gossip is distributed and knows the last phase only; "
      "choose last, or another strategy");
  CHECK(message_of("gossip,prediction=last").empty());
  BalanceOptions three;
  three.speeds = {1, 2, 3};
  CHECK_THROWS_AS(validate(three, 2), Error);
  three.speeds = {1, 0};
  CHECK_THROWS_AS(validate(three, 2), Error);
}
