// What the laboratory measures, on a machine that repeats to the bit; what it writes; what it
// refuses.
#include "apps/lb_lab/output/replay.hpp"
#include "apps/lb_lab/output/report.hpp"
#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/balance/strategy.hpp"
#include "tests/apps/lb_lab/on_simulated.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace lb_lab;
using tess::test::Scratch;

namespace {

Settings linear() {
  Settings s;
  s.workloads = {"linear"};
  s.per_pe = {1, 16};
  s.strategies = {"greedy", "refine"};
  s.n_iterations = 20;
  s.period = 2;
  return s;
}

/// The table of a replay without its column of times, which differ from run to run.
std::string without_times(const std::string& table) {
  std::string result;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);)
    result +=
        line.starts_with("left out") ? line + '\n' : line.substr(0, 94) + line.substr(107) + '\n';
  return result;
}

/// A snapshot on two PEs without positions, in a file of this name.
std::string save_without_positions(const Scratch& scratch, const char* name) {
  tess::balance::Snapshot s;
  s.pes = {{0, 0}, {1, 1}, {0, 0}, {}};
  s.blocks.push_back({3, 100, tess::PeId{0}});
  auto& e = s.elements;
  for (std::size_t i = 0; i < 8; ++i) {
    e.key.push_back({tess::CollectionId{7}, i});
    e.pe.push_back(tess::PeId{0});
    e.load.push_back(1);
    e.migratable.push_back(1);
    e.size_bytes.push_back(1);
    e.memory_bytes.push_back(10);
    e.block.push_back(0);
  }
  const std::string file = scratch.path(name);
  const std::string text = tess::balance::write_lb_datafile({{0, s}, {1, s}});
  std::ofstream(file, std::ios::binary) << tess::balance::lb_datafile_bytes(file, text);
  return file;
}

const Row& row_of(const Sweep& sweep, const std::string& strategy, std::int32_t per_pe) {
  for (const Row& row : sweep.rows)
    if (row.strategy == strategy && row.per_pe == per_pe) return row;
  FAIL("no row of " << strategy << " with " << per_pe);
  return sweep.rows.front();
}

}  // namespace

TEST_CASE("work by index is balanced once there are chares to move, and its ideal is exact",
          "[lb_lab]") {
  const Sweep sweep = sweep_on("pes=4,cost=1us", linear());
  // 64 cells on 4 PEs: the last PE has 49 … 64, of 1 … 64.
  const double before = 4 * (49 + 64) * 8.0 / (64 * 65 / 2.0);
  for (const std::int32_t per_pe : {1, 16})
    for (const char* strategy : {"none", "greedy", "refine"})
      CHECK(row_of(sweep, strategy, per_pe).imbalance_before == Approx(before).epsilon(1e-3));
  CHECK(row_of(sweep, "none", 16).imbalance_after == Approx(before).epsilon(1e-3));
  CHECK(row_of(sweep, "greedy", 1).imbalance_after == Approx(before).epsilon(1e-3));
  CHECK(row_of(sweep, "greedy", 16).imbalance_after <= 1.05);
  CHECK(row_of(sweep, "refine", 16).imbalance_after <= 1.10);
  CHECK(row_of(sweep, "none", 16).ideal_seconds == Approx(20 * 16e-3).epsilon(0.01));
  // One phase of ten at `before`, nine that are balanced.
  CHECK(row_of(sweep, "greedy", 16).gain > 0.35);
  CHECK(row_of(sweep, "none", 16).gain == 0);
  CHECK(&best_of(sweep, "linear") == &row_of(sweep, "greedy", 16));
}

TEST_CASE("a PE of half the speed gets half the work", "[lb_lab]") {
  Settings s = linear();
  s.workloads = {"uniform"};
  s.speeds = {1, 1, 1, 0.5};
  const Sweep sweep = sweep_on("pes=4,cost=1us", s);
  CHECK(row_of(sweep, "none", 16).imbalance_before == Approx(2 * 3.5 / 4).epsilon(1e-3));
  CHECK(row_of(sweep, "greedy", 16).imbalance_after <= 1.05);
}

TEST_CASE("the least time that is explained counts speeds as the workload does", "[lb_lab]") {
  Settings s = linear();
  s.strategies = {"none"};
  s.speeds = {2, 2};
  const auto best_of_two = [&](const char* workload) {
    s.workloads = {workload};
    const std::string text = explain_text(s, 2);
    double work = 0, best = 0;
    REQUIRE(std::sscanf(text.c_str() + text.rfind("; ", text.find(" of work,")),
                        "; %lf s of work, %lf", &work, &best) == 2);
    return work / best;
  };
  CHECK(best_of_two("linear") == Approx(4).epsilon(1e-3));
  CHECK(best_of_two("particles") == Approx(2).epsilon(1e-3));
}

TEST_CASE("automatic rounds lose next to nothing where nothing can be gained", "[lb_lab]") {
  Settings s = linear();
  s.workloads = {"uniform", "uniform_comm"};
  s.when = "automatic";
  const Sweep sweep = sweep_on("pes=4,cost=1us", s);
  for (const Row& row : sweep.rows) {
    CHECK(row.gain >= -0.02);
    CHECK(row.n_moves == 0);
  }
}

TEST_CASE("rounds beside the work count no moves of chares that have ended", "[lb_lab]") {
  Settings s = linear();
  s.per_pe = {4};
  s.strategies = {"diffusion", "gossip"};
  s.when = "periodic";
  const Sweep sweep = sweep_on("pes=64,cost=1us", s);
  for (const Row& row : sweep.rows) CHECK((row.n_moves > 0) == (row.moved_bytes > 0));
}

TEST_CASE("a row says all of a run, and the best is named", "[lb_lab]") {
  const Sweep sweep = sweep_on("pes=4,cost=1us", linear());
  const kit::Json rows = report().json(sweep.rows);
  REQUIRE(rows.members().size() == sweep.rows.size());
  const kit::Json& row = rows.members().front().value;
  CHECK(row.at("workload").text() == "linear");
  CHECK(row.at("result_hash").text().size() == 16);
  CHECK(row.at("seconds_per_iteration").real() * sweep.rows.front().n_iterations ==
        Approx(row.at("seconds_total").real()));
  CHECK(row.at("imbalance_of_iteration").members().size() == 20);
  CHECK(best_json(sweep).members().front().value.at("strategy").text() == "greedy");
}

TEST_CASE("a row says what limits it, as the loads of linear work say", "[lb_lab]") {
  Settings s = linear();
  s.repeat = 3;
  const Sweep sweep = sweep_on("pes=4,cost=1us", s);
  // 64 cells on 4 PEs: the mean of 1 … 64 against the 49 … 64 of the last PE, or against cell 64.
  const tess::LoadSummary& none = row_of(sweep, "none", 16).limits;
  CHECK(none.wait == Approx(1 - 32.5 / 56.5).epsilon(0.01));
  CHECK(none.balance == Approx(1 - 32.5 / 56.5).epsilon(0.01));
  CHECK(none.element == Approx(1 - 32.5 / 56.5).epsilon(0.01));
  CHECK(none.largest == "lb_lab::Worker[63]");
  CHECK(row_of(sweep, "none", 1).limits.element < 0.001);
  CHECK(row_of(sweep, "greedy", 16).limits.wait < 0.1);
  CHECK(none.runtime > 0);
  CHECK(none.runtime < 0.01);
  CHECK(row_of(sweep, "none", 16).seconds_of_runs.size() == 3);
  const kit::Json row = report().json(sweep.rows).members().front().value;
  CHECK(row.at("seconds_of_runs").members().size() == 3);
  CHECK(row.at("limits").at("sentence").text() == describe(row_of(sweep, "none", 1).limits));
  CHECK_THAT(best_text(sweep),
             Contains("  none: PEs wait 42 % of the time") && Contains("  greedy: PEs wait "));
}

TEST_CASE("the snapshots given to a strategy are saved, and their replay gives the same prediction",
          "[lb_lab]") {
  const Scratch scratch;
  Settings s = linear();
  s.per_pe = {16};
  s.strategies = {"greedy"};
  s.snapshots = scratch.path("");
  s.plot = scratch.path("");
  const Sweep sweep = sweep_on("pes=4,cost=1us", s);
  for (const char* name : {"time", "imbalance", "timeline-none", "timeline-greedy"})
    CHECK(std::filesystem::exists(scratch.path(std::string("linear-") + name + ".csv")));
  for (int pe = 0; pe < 4; ++pe)
    s.replay.push_back(scratch.path("linear-16-greedy/data." + std::to_string(pe) + ".json.br"));
  s.strategies = {"none", "greedy"};
  const Replayed replayed = replay(s);
  CHECK_THAT(replayed.summary,
             Contains("under greedy: PEs wait") && Contains("best of 2 strategies: greedy, max/"));
  CHECK(replayed.strategies.members().size() == 2);
  CHECK(replayed.last_phase.members().size() == 2);
  const auto& rows = replayed.rows.members();
  CHECK(rows.size() == static_cast<std::size_t>(std::ranges::count(replayed.table, '\n') - 1));
  std::size_t at = 0;
  std::istringstream lines(replayed.table);
  std::string line;
  std::getline(lines, line);
  for (const char* strategy : {"none", "greedy"}) {
    std::size_t phase = 9, n_pes = 0, n_elements = 0, moves = 0;
    std::string name;
    double before = 0, predicted = 0;
    lines >> phase >> n_pes >> n_elements >> name >> before >> predicted >> moves;
    CHECK(phase == 0);
    CHECK(n_pes == 4);
    CHECK(n_elements == 64);
    CHECK(name == strategy);
    CHECK(before == Approx(1.738).epsilon(2e-3));
    CHECK((name == "none" ? predicted == before : predicted <= 1.05));
    const kit::Json& row = rows.at(at++).value;
    CHECK(row.at("strategy").text() == strategy);
    CHECK(row.at("imbalance_predicted").real() == Approx(predicted).margin(6e-4));
    CHECK(row.at("moves").text() == std::to_string(moves));
    std::getline(lines, line);
  }
  s.replay_pes = 7;
  s.strategies = {"graph"};
  CHECK_THAT(replay(s).table, Contains("      7        64 graph"));
  s.speeds = {1, 2};
  CHECK_THROWS_WITH(replay(s), Contains("2 speeds for a replay on 7 PEs"));
}

TEST_CASE("compressed and plain snapshots replay alike", "[lb_lab]") {
  const Scratch scratch;
  Settings s = linear();
  s.per_pe = {4};
  s.strategies = {"greedy"};
  std::map<std::string, std::string> table;
  for (const char* format : {"json", "json.br"}) {
    s.replay.clear();
    s.snapshots = scratch.path(format);
    s.snapshot_format = format;
    (void)sweep_on("pes=2,cost=1us", s);
    for (int pe = 0; pe < 2; ++pe)
      s.replay.push_back(s.snapshots + "/linear-4-greedy/data." + std::to_string(pe) + '.' +
                         format);
    Settings all = s;
    all.strategies = {"all"};
    table[format] = without_times(replay(all).table);
  }
  CHECK(table["json"] == table["json.br"]);
  CHECK_THAT(table["json"], Contains("hilbert"));
  CHECK_THAT(table["json"], !Contains("left out"));

  Settings folder = s;
  folder.strategies = {"all"};
  folder.replay = {s.snapshots + "/linear-4-greedy"};
  CHECK(without_times(replay(folder).table) == table["json"]);
  folder.replay = {scratch.path("")};
  CHECK_THROWS_WITH(replay(folder), Contains("has no file named *.json"));
}

TEST_CASE("a saved snapshot has the index of each element and its measured load", "[lb_lab]") {
  const Scratch scratch;
  Settings s = linear();
  s.per_pe = {4};
  s.strategies = {"greedy"};
  s.snapshots = scratch.path("");
  s.snapshot_format = "json";
  (void)sweep_on("pes=4,cost=1us", s);
  REQUIRE(std::filesystem::exists(scratch.path("linear-4-greedy/data.3.json")));
  (void)sweep_on("pes=2,cost=1us", s);
  CHECK_FALSE(std::filesystem::exists(scratch.path("linear-4-greedy/data.3.json")));
  double first = 0;
  for (int pe = 0; pe < 2; ++pe) {
    std::ifstream file(scratch.path("linear-4-greedy/data." + std::to_string(pe) + ".json"));
    const nlohmann::json root = nlohmann::json::parse(file);
    const nlohmann::json& tasks = root.at("phases").at(0).at("tasks");
    REQUIRE(tasks.size() == 4);
    for (int k = 0; k < 4; ++k) {
      const nlohmann::json& task = tasks.at(static_cast<std::size_t>(k));
      CHECK(task.at("entity").at("index") == nlohmann::json::array({4 * pe + k}));
      // The cells of chare x are the x-th part of a line whose cells cost in proportion to their
      // number.
      const double load = task.at("time").get<double>();
      if (pe == 0 && k == 0) first = load;
      CHECK(load > 0);
      CHECK((4 * pe + k == 0 || load > first));
    }
  }
}

TEST_CASE("all leaves out what a snapshot without positions cannot serve, and says so",
          "[lb_lab]") {
  const Scratch scratch;
  Settings s;
  s.replay = {save_without_positions(scratch, "data.0.json.br")};
  s.strategies = {"all"};
  const std::string table = replay(s).table;
  for (const std::string& name : tess::balance::strategy_names()) {
    INFO(name);
    const bool is_row = table.find("         8 " + name + ' ') != std::string::npos;
    const bool is_left_out = table.find("left out in 2 of 2 phases: " + name +
                                        ": the snapshot does not have") != std::string::npos;
    CHECK(is_row == (name != "rcb" && name != "hilbert"));
    CHECK(is_left_out == !is_row);
  }
  s.strategies = {"greedy", "rcb"};
  CHECK_THROWS_WITH(replay(s), Contains("--strategy rcb: the snapshot does not have") &&
                                   Contains("data.0.json.br"));
}

TEST_CASE("memory limits of a replay count a shared block once per PE", "[lb_lab]") {
  const Scratch scratch;
  Settings s;
  s.replay = {save_without_positions(scratch, "data.0.json")};
  s.strategies = {"greedy"};
  const auto moves = [&](std::vector<std::uint64_t> limits) {
    s.memory_limits = std::move(limits);
    std::istringstream lines(replay(s).table);
    std::string line, name;
    std::getline(lines, line);
    std::size_t phase = 0, n_pes = 0, n_elements = 0, n_moves = 0, fullest = 0, n_over = 9;
    double before = 0, predicted = 0, bytes = 0, external = 0, took = 0;
    lines >> phase >> n_pes >> n_elements >> name >> before >> predicted >> n_moves >> bytes >>
        external >> took >> fullest >> n_over;
    return std::vector<std::size_t>{n_moves, fullest, n_over};
  };
  using Numbers = std::vector<std::size_t>;
  CHECK(moves({}) == Numbers{4, 140, 0});
  CHECK(moves({140}) == Numbers{4, 140, 0});
  CHECK(moves({0, 120}) == Numbers{2, 160, 0});
  CHECK(moves({150, 109}) == Numbers{0, 180, 1});  // above its limit as it is
  CHECK_THROWS_WITH(moves({1, 2, 3}), Contains("--memory-limit: 3 limits for 2 PEs"));
}
