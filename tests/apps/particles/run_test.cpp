// Whole runs: the same bits on any number of PEs, under any schedule and any cut of space, and the
// bits of a plain loop over all particles.
#include "runtime/balance/strategy.hpp"
#include "runtime/balance_options.hpp"
#include "tests/apps/particles/run_scene.hpp"

#include <fmt/core.h>

using namespace particles;

namespace {

/// Two masses, two objects of which one moves and spins and one shrinks, every kind of rule, an
/// explosion that begins and ends within steps.
Scene lively_scene() {
  return scene_of(R"({"dt": 0.01, "steps": 40,
    "objects": [{"shape": {"sphere": {"radius": 0.5, "rings": 8}}, "resolution": 20, "thickness": 0.3,
                 "motion": {"velocity": [0.2, 0, 0], "spin": [0, 2, 1]}},
                {"shape": {"box": {"half": [1, 1, 0.2]}}, "resolution": 16, "thickness": 0.4,
                 "transform": {"position": [0, 0, -1.2], "rotation": [10, 0, 0], "scale": 1.5},
                 "motion": {"scale": -0.4}}],
    "emitters": [{"count": 60, "box": {"low": [-1, -1, 0.6], "high": [1, 1, 1.5]}, "spread": 2, "mass": 2},
                 {"count": 60, "sphere": {"centre": [0, 0, 0], "radius": 1.2, "inner": 0.8}, "outward": -3}],
    "rules": {"gravity": [0, 0, -9.81], "impact": {"restitution": 0.8},
              "surface_drag": {"rate": 3, "threshold": 0.1},
              "surface_flow": {"alpha_in": 5, "alpha_out": -2, "distance": 0.2},
              "air_drag": {"rate": 0.1, "law": "quadratic"},
              "explosions": [{"centre": [0, 0, -0.5], "strength": 50, "radius": 2, "start": 0.123, "duration": 0.0571}]},
    "outputs": {"statistics": 15, "trajectories": 20, "traced": 30, "audit": false}})");
}

void check_same(const Ran& ran, const Ran& first) {
  REQUIRE(ran.result.rows.size() == first.result.rows.size());
  for (std::size_t i = 0; i < ran.result.rows.size(); ++i) {
    const Measured &a = ran.result.rows[i].measured, &b = first.result.rows[i].measured;
    CHECK(a.particles == b.particles);
    CHECK(a.hash == b.hash);
    CHECK(a.kinetic.total() == b.kinetic.total());
    CHECK(a.energy() == b.energy());
    CHECK(a.nearest == b.nearest);
    CHECK(a.inside == b.inside);
  }
  REQUIRE(ran.result.trajectories.size() == first.result.trajectories.size());
  for (std::size_t i = 0; i < ran.result.trajectories.size(); ++i) {
    const auto &a = ran.result.trajectories[i].samples, &b = first.result.trajectories[i].samples;
    REQUIRE(a.size() == b.size());
    for (std::size_t p = 0; p < a.size(); ++p)
      CHECK((a[p].id == b[p].id && a[p].position == b[p].position));
  }
}

/// Runs the scene with blocks that a balancer moves, checks that it ends as `first` did, and gives
/// the number of moves.
std::size_t moves_of(const Ran& first, const std::string& machine, const std::string& balance) {
  INFO(machine << " --balance " << balance);
  Scene scene = lively_scene();
  scene.block = 0.3;
  scene.exchange = 2;
  RunOptions how;
  how.balance = tess::parse_balance(balance);
  const Ran ran = run_scene(scene, machine, how);
  check_same(ran, first);
  std::size_t moves = 0;
  for (const auto& round : ran.result.rounds) moves += round.n_moved;
  return moves;
}

}  // namespace

TEST_CASE("a run gives the bits of a plain loop over all particles", "[particles][run]") {
  const Ran ran = run_scene(lively_scene(), "--pes=1");
  CHECK(ran.result.rows.front().measured.particles == 120);
  CHECK(ran.last().particles == 120);
  CHECK(ran.last().nonfinite == 0);
  const Measured want = run_serially(*ran.stage);
  CHECK(ran.last().hash == want.hash);
  CHECK(ran.last().energy() == want.energy());
  CHECK(ran.last().hash != ran.result.rows.front().measured.hash);
}

TEST_CASE("a run gives the same bits on any PEs, under any schedule and any cut of space",
          "[particles][run]") {
  const Ran first = run_scene(lively_scene(), "--pes=1");
  CHECK(first.result.trajectories.size() == 3);
  CHECK(first.result.trajectories.back().samples.size() == 30);
  for (const char* option : {"--pes=2", "--pes=4"})
    check_same(run_scene(lively_scene(), option), first);
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    INFO("seed " << seed);
    Scene scene = lively_scene();
    if (seed % 3 == 1) scene.block = 0.2;
    if (seed % 3 == 2) scene.exchange = 1;
    scene.outputs.audited = seed % 3 * 60;
    check_same(run_scene(scene, fmt::format("--sim=pes=6,per-process=2,migrate=0.1,seed={}", seed)),
               first);
  }
  for (const double edge : {0.05, 0.7, 100.0})
    for (const int exchange : {1, 7, 1000}) {
      Scene scene = lively_scene();
      scene.block = edge;
      scene.exchange = exchange;
      check_same(run_scene(scene, "--sim=pes=3"), first);
    }
}

TEST_CASE("a block ends when it is empty and is made again by a particle that enters",
          "[particles][run]") {
  // One particle to and fro between two walls, through ten blocks.
  const Scene scene = scene_of(R"({"dt": 0.1, "steps": 200, "block": 0.2, "exchange": 1,
    "objects": [{"shape": {"boxes": [{"low": [-2, -1, -1], "high": [-1, 1, 1]}, {"low": [1, -1, -1], "high": [2, 1, 1]}]},
                 "resolution": 40, "thickness": 0.5}],
    "emitters": [{"lattice": {"low": [0, 0, 0], "high": [0, 0, 0], "n": [1, 1, 1]}, "velocity": [1.05, 0, 0]}],
    "rules": {"impact": {"restitution": 1}}, "outputs": {"statistics": 1, "audit": true}})");
  for (const char* option : {"--pes=2", "--sim=pes=4,seed=5,migrate=0.2"}) {
    const Ran ran = run_scene(scene, option);
    REQUIRE(ran.result.rows.size() == 201);
    for (const Row& row : ran.result.rows) {
      CHECK(row.measured.blocks == 1);
      CHECK(row.measured.particles == 1);
      CHECK(row.measured.kinetic.total() == Approx(0.5 * 1.05 * 1.05).epsilon(1e-6));
    }
    CHECK(ran.last().tunnelled == 0);
  }
}

TEST_CASE("the column of blocks counts blocks, not looks at them", "[particles][run]") {
  // At rest, one particle in each of eight blocks.
  const Scene scene = scene_of(R"({"dt": 0.1, "steps": 60, "block": 1,
    "emitters": [{"lattice": {"low": [0.5, 0.5, 0.5], "high": [1.5, 1.5, 1.5], "n": [2, 2, 2]}}],
    "outputs": {"statistics": 30, "trajectories": 2}})");
  const Ran ran = run_scene(scene, "--pes=2");
  REQUIRE(ran.result.rows.size() == 3);
  CHECK(ran.result.trajectories.size() == 31);
  for (const Row& row : ran.result.rows) CHECK(row.measured.blocks == 8);
}

TEST_CASE("an energy beyond all doubles is not reported as none", "[particles][run]") {
  // All numbers are allowed, but not the velocities that come of them.
  const Scene scene = scene_of(R"({"dt": 1e60, "steps": 2,
    "emitters": [{"count": 3, "box": {"low": [0, 0, 0], "high": [1, 1, 1]}}],
    "rules": {"gravity": [0, 0, -1e100]}})");
  const Measured begin = run_scene(scene, "--pes=2").result.rows.front().measured;
  const Measured end = run_scene(scene, "--pes=2").last();
  CHECK(begin.energy() == Approx(1.5e100).epsilon(1));
  CHECK(end.particles == 3);
  CHECK(end.nonfinite == 0);
  CHECK(end.kinetic.total() == HUGE_VAL);
  CHECK(end.fastest == HUGE_VAL);
  CHECK_FALSE(std::isfinite(end.energy()));
}

TEST_CASE("a run gives the same bits whatever a balancer moves", "[particles][run][balance]") {
  const Ran first = run_scene(lively_scene(), "--pes=1");
  CHECK(first.result.rounds.empty());
  // Every block of every round.
  CHECK(moves_of(first, "--sim=pes=3,seed=5", "none") == 0);
  CHECK(moves_of(first, "--sim=pes=3,seed=5", "rotate") > 500);
  CHECK(moves_of(first, "--pes=2", "rotate") > 500);
  CHECK(moves_of(first, "--pes=4", "greedy,when=periodic,period=1ms") < 1'000'000);
}

TEST_CASE("a run gives the same bits under every strategy",
          "[particles][run][balance][one_thread]") {
  const Ran first = run_scene(lively_scene(), "--pes=1");
  std::uint64_t seed = 0;
  for (const std::string& strategy : tess::balance::strategy_names())
    for (const char* when : {"at_sync", "automatic", "periodic,period=2ms"}) {
      ++seed;
      (void)moves_of(first,
                     fmt::format("--sim=pes=6,per-process=2,cost=1us,migrate={},seed={}",
                                 seed % 2 == 0 ? "0.1" : "0", seed),
                     fmt::format("{},when={},seed={}", strategy, when, seed));
    }
}

TEST_CASE("a balancer spreads blocks that are born on one PE", "[particles][run][balance]") {
  // All particles begin in one block, and fly apart.
  Scene scene = scene_of(R"({"dt": 0.01, "steps": 80, "block": 0.25, "exchange": 4,
    "emitters": [{"count": 4000, "sphere": {"radius": 0.01}, "outward": 2, "spread": 0.5}],
    "rules": {"gravity": [0, 0, -1]}})");
  RunOptions how;
  how.balance = tess::parse_balance("greedy");
  const Ran ran = run_scene(scene, "--sim=pes=4,cost=1us", how);
  REQUIRE(ran.result.rounds.size() == 20);
  CHECK(ran.result.rounds.front().n_elements < 30);
  CHECK(ran.result.rounds.back().n_elements > 40);
  CHECK(ran.result.rounds.back().predicted < 1.2);
  CHECK(ran.last().hash == run_scene(scene, "--pes=1").last().hash);
}

TEST_CASE("a run in compressed fields gives the same bits on any PEs, and near those of flat ones",
          "[particles][run]") {
  const auto compressed = [] {
    Scene scene = lively_scene();
    compress_fields(scene);
    return scene;
  };
  const Ran first = run_scene(compressed(), "--pes=1");
  CHECK(first.last().hash == run_serially(*first.stage).hash);
  CHECK(first.stage->fields[0].field().distance.empty());
  const FieldCost& fields = first.result.fields;
  CHECK(fields.bytes == fields.cells * 8);
  CHECK(fields.bytes_used > 0);
  CHECK(fields.bytes_used < fields.bytes);
  for (const char* option :
       {"--pes=2", "--pes=4", "--sim=pes=6,per-process=2,migrate=0.1,seed=3", "--sim=pes=3"})
    check_same(run_scene(compressed(), option), first);
  RunOptions how;
  how.balance = tess::parse_balance("rotate");
  check_same(run_scene(compressed(), "--sim=pes=4,per-process=2,seed=2", how), first);
  const Ran flat = run_scene(lively_scene(), "--pes=1");
  CHECK(flat.last().hash != first.last().hash);
  CHECK(flat.result.fields.bytes_used == 0);
  CHECK(first.last().energy() == Approx(flat.last().energy()).epsilon(0.02));
}
