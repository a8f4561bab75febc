// Compares collisions on the runtime with all pairs: on the simulated machine, with adversarial
// delivery order and forced migration, and on threads. Each pair is reported once to each of its
// two owners (once, if they are the same). There are several collisions in a row, and the boxes
// move between them.
#include "collide/collider.hpp"

#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/capsule_of_box.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/reported_pairs.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <random>

using namespace tess;
using namespace tess::collide;

namespace {

struct Scene {
  std::uint64_t seed = 0;
  std::int32_t n_clients = 1;
  std::int32_t n_boxes = 0;  ///< per client
  std::int32_t n_models = 1;
  std::int32_t round = 0;    ///< boxes move from round to round
  std::int32_t n_large = 0;  ///< boxes per client that are 40 times as large, so on a higher level
  /// Boxes may have capsules around them, which changes no pair.
  std::int32_t n_with_capsules = 0;  ///< clients whose boxes have some
};

/// The boxes of a client, as a function of the scene, so that the oracle can compute them too. In
/// half of the scenes they lie on a coarse lattice, and touch each other and the faces of voxels.
std::vector<Item> boxes_of(const Scene& scene, std::int32_t client) {
  std::seed_seq seeds{scene.seed, static_cast<std::uint64_t>(scene.round),
                      static_cast<std::uint64_t>(client)};
  std::mt19937_64 random(seeds);
  std::uniform_real_distribution<double> place(-2, 2), extent(0, 0.8);
  const bool on_lattice = scene.seed % 2 == 0;
  std::vector<Item> items;
  for (std::int32_t i = 0; i < scene.n_boxes; ++i) {
    Item item{{},
              {owner_of(Index1{client}), static_cast<LocalId>(i),
               static_cast<ModelId>(random() % static_cast<std::uint64_t>(scene.n_models))}};
    for (std::size_t k = 0; k < 3; ++k) {
      double lo = place(random), width = i % 4 == 0 ? 0 : extent(random);
      if (on_lattice) lo = std::round(4 * lo) / 4, width = std::round(4 * width) / 4;
      item.box.lo[k] = lo;
      item.box.hi[k] = lo + (i < scene.n_large ? 40 : 1) * width;
    }
    items.push_back(item);
  }
  return items;
}

using test::in_order, test::Reports;

Reports oracle(const Scene& scene, PairRules rules, std::optional<ModelId> only) {
  std::vector<Item> all;
  for (std::int32_t c = 0; c < scene.n_clients; ++c) {
    const auto items = boxes_of(scene, c);
    all.insert(all.end(), items.begin(), items.end());
  }
  return test::all_reports(all, rules, only);
}

/// A collider, and the arguments of its run().
struct Collision {
  Collider collider;
  HitReceivers receivers;
  Callback<void> taken;
};
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr std::int32_t kRounds = 2, kOverlapping = 3;

class Client : public Chare<Client, Index1> {
 public:
  void submit(const Collider& collider, const Scene& scene) {
    reported_.clear();
    n_refused_ = 0;
    submit_more(collider, scene);
  }
  /// Submits the same boxes, the last with a NaN. All of them are refused.
  void submit_bad(const Collider& collider, const Scene& scene) {
    std::vector<Item> items = boxes_of(scene, index().x);
    items.back().box.hi[1] = std::numeric_limits<double>::quiet_NaN();
    try {
      n_left_out_ = static_cast<std::int64_t>(collider.submit(items));
    } catch (const Error& error) {
      const std::string name = fmt::format("object {} of owner [{}]", scene.n_boxes - 1, index().x);
      const bool names_it = std::string_view(error.what()).find(name) != std::string_view::npos;
      if (names_it) ++n_refused_;
    }
  }
  void receive(const Hits& hits) {
    TESS_CHECK(hits.owner == owner_of(index()), "hits of another owner");
    test::add(reported_, hits);
  }
  Task collide(Collision collision) {
    co_await collision.collider.run(collision.receivers, collision.taken);
  }
  /// Starts a collision per round when the objects of the one before are taken.
  Task collide_in_a_row(Collision collision, Scene scene) {
    for (scene.round = 0; scene.round < kOverlapping; ++scene.round) {
      co_await epoch([&] { array().broadcast<&Client::submit_more>(collision.collider, scene); });
      Future<void> taken;
      collision.taken = taken.callback();
      array()[index()].send<&Client::collide>(collision);
      co_await taken;
    }
  }
  void submit_more(const Collider& collider, const Scene& scene) {
    const std::vector<Item> items = boxes_of(scene, index().x);
    std::vector<Capsule> capsules;
    if (index().x < scene.n_with_capsules)
      for (const Item& item : items) capsules.push_back(test::capsule_of_box(item.box));
    collider.submit(items, capsules);
  }
  /// Of one model. Does not need to know the collider.
  void submit_early(const Collider& collider, const Scene& scene) {
    std::vector<Aabb> boxes;
    for (const Item& item : boxes_of(scene, index().x)) boxes.push_back(item.box);
    collider.submit_early({owner_of(index()), ModelId{}, std::move(boxes)});
  }
  void gather(Callback<Reports> target) { contribute(concatenate, reported_, std::move(target)); }
  void count_refused(Callback<std::int64_t> target) {
    contribute(sum, n_refused_, std::move(target));
  }
  void count_left_out(Callback<std::int64_t> target) {
    contribute(sum, n_left_out_, std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(reported_, n_refused_, n_left_out_);
  }

 private:
  Reports reported_;
  std::int64_t n_refused_ = 0, n_left_out_ = 0;
};

struct Problem {
  Scene scene;
  ColliderOptions options;
  std::optional<ModelId> only;
  std::vector<Reports> rounds;  ///< the reports of each collision
  std::int64_t n_refused = 0, n_left_out = 0, n_sent_of_one_model = -1, n_sent_of_two_models = -1;
  GridCounts grid;
  std::string error;
  std::size_t n_left = 0;  ///< collections on PE 0 after all are destroyed
};

constexpr Aabb far_box{{100, 100, 100}, {101, 101, 101}};

/// A collider of a problem and its clients.
struct Fixture {
  Collider collider;
  ArrayProxy<Client> clients;
  HitReceivers receivers;

  void submit(const Scene& scene) const { clients.broadcast<&Client::submit>(collider, scene); }
};

Task set_up(const Problem& problem, Fixture& fixture) {
  co_await epoch([&] {
    fixture.collider = make_collider(problem.options);
    fixture.clients = create<Client>(range(problem.scene.n_clients));
  });
  fixture.receivers = {report_to<&Client::receive>(fixture.clients), problem.only};
}

/// Adds what the clients have received to the rounds of the problem.
Task gather(const Fixture& fixture, Problem& problem) {
  problem.rounds.push_back(in_order(co_await fixture.clients.reduce<&Client::gather>()));
}

Task collide_rounds(Problem& problem) {
  Fixture fixture;
  co_await set_up(problem, fixture);
  Scene scene = problem.scene;
  for (scene.round = 0; scene.round < kRounds; ++scene.round) {
    co_await epoch([&] { fixture.submit(scene); });
    co_await fixture.collider.run(fixture.receivers);
    co_await gather(fixture, problem);
  }
  co_await epoch([&] {
    fixture.collider.destroy();
    fixture.clients.destroy();
  });
  problem.n_left = current_pe().collections().all().size();
}

/// The objects are submitted in the epoch that creates the collider.
Task collide_early(Problem& problem) {
  Fixture fixture;
  co_await set_up(problem, fixture);
  co_await epoch([&] {
    fixture.collider = make_collider(problem.options);
    fixture.clients.broadcast<&Client::submit_early>(fixture.collider, problem.scene);
  });
  co_await fixture.collider.run(fixture.receivers);
  co_await gather(fixture, problem);
}

Task collide_bad(Problem& problem) {
  Fixture fixture;
  co_await set_up(problem, fixture);
  co_await epoch(
      [&] { fixture.clients.broadcast<&Client::submit_bad>(fixture.collider, problem.scene); });
  co_await fixture.collider.run(fixture.receivers);
  problem.n_refused = co_await fixture.clients.reduce<&Client::count_refused>();
  problem.n_left_out = co_await fixture.clients.reduce<&Client::count_left_out>();
  co_await gather(fixture, problem);
}

/// Two colliders at once, and of each a second collision of nothing.
Task collide_overlapping(Problem& problem) {
  Fixture fixture;
  co_await set_up(problem, fixture);
  Collider other;
  co_await epoch([&] { other = make_collider(problem.options); });
  co_await epoch([&] {
    for (const Collider& collider : {fixture.collider, other})
      fixture.clients.broadcast<&Client::submit_more>(collider, problem.scene);
  });
  co_await epoch([&] {
    for (int i = 0; i < 2; ++i)
      for (const Collider& collider : {fixture.collider, other})
        fixture.clients[Index1{problem.scene.n_clients - 1}].send<&Client::collide>(
            Collision{collider, fixture.receivers, {}});
  });
  co_await gather(fixture, problem);
}

/// The boxes of a round are submitted as soon as those of the one before are taken.
Task collide_in_a_row(Problem& problem) {
  Fixture fixture;
  co_await set_up(problem, fixture);
  co_await epoch([&] {
    fixture.clients[Index1{0}].send<&Client::collide_in_a_row>(
        Collision{fixture.collider, fixture.receivers, {}}, problem.scene);
  });
  co_await gather(fixture, problem);
}

Task collide_apart(Problem& problem) {
  Fixture fixture;
  co_await set_up(problem, fixture);
  for (std::int64_t* sent : {&problem.n_sent_of_one_model, &problem.n_sent_of_two_models}) {
    co_await epoch([&] { fixture.submit(problem.scene); });
    if (sent == &problem.n_sent_of_two_models)
      fixture.collider.submit(
          Objects{owner_of(Index1{0}), ModelId{7}, std::array{far_box, far_box}});
    co_await fixture.collider.run(fixture.receivers);
    const GridCounts grid = (co_await fixture.collider.statistics()).grid;
    *sent = static_cast<std::int64_t>(grid.n_entries - grid.n_left_out);
  }
  co_await gather(fixture, problem);
}

/// Along x the voxels 0, 3 and 6 have two boxes each, and the last box is in voxel 7, too.
Task count_grid(Problem& problem) {
  const std::array of_model_0{Aabb{{0, 0, 0}, {0.25, 1, 1}}, Aabb{{3.25, 0, 0}, {3.5, 1, 1}},
                              Aabb{{3.5, 0, 0}, {3.75, 1, 1}}, Aabb{{6.25, 0, 0}, {6.5, 1, 1}}};
  const std::array of_model_1{Aabb{{0.5, 0, 0}, {0.75, 1, 1}}, Aabb{{6.5, 0, 0}, {7.5, 1, 1}}};
  Fixture fixture;
  co_await set_up(problem, fixture);
  fixture.collider.submit(Objects{owner_of(Index1{0}), ModelId{0}, of_model_0});
  fixture.collider.submit(Objects{owner_of(Index1{0}), ModelId{1}, of_model_1, LocalId{4}});
  co_await fixture.collider.run(fixture.receivers);
  problem.grid = (co_await fixture.collider.statistics()).grid;
}

Task collide_refused(Problem& problem) {
  Fixture fixture;
  co_await set_up(problem, fixture);
  co_await epoch([&] { fixture.submit(problem.scene); });
  try {
    co_await fixture.collider.run(fixture.receivers);
  } catch (const Error& error) {
    problem.error = error.what();
  }
  co_await fixture.collider.run(fixture.receivers);  // nothing is submitted
  co_await gather(fixture, problem);
}

template <class Program>
int run_with(const std::string& option, const Program& program) {
  Setup setup = tests::setup_of(option);
  return run(setup, [&program] { return program(); });
}
int run_with(const std::string& option, Problem& problem, Task (*program)(Problem&)) {
  return run_with(option, [&]() { return program(problem); });
}

/// Varies the numbers of clients and models, the rules and the voxel size with the seed.
Problem problem_of(std::uint64_t seed) {
  Problem problem;
  problem.scene = {seed,
                   static_cast<std::int32_t>(1 + seed % 7),
                   static_cast<std::int32_t>(20 + seed % 3 * 10),
                   static_cast<std::int32_t>(seed / 8 % 4 == 3 ? 12 : 1 + seed % 3),
                   0,
                   0,
                   seed % 5 < 2 ? static_cast<std::int32_t>(seed % 9) : 0};
  problem.options.piece_length = std::array{0.0, 0.01, 0.1, 0.5, 2.0, inf}[seed / 2 % 6];
  if (seed / 4 % 3 == 2) {
    problem.options.slack = std::array{1e-3, 0.2, 3.0}[seed / 12 % 3];
    problem.scene.n_with_capsules = 0;
  }
  const double size = std::array{0.25, 0.5, 0.7, 1.3, 10.0, 1e-3}[seed % 6];
  problem.options.origin = {seed % 4 == 0 ? 0 : 0.1, 0, -0.3};
  if (seed % 3 == 0) {  // chosen; the scene has a few large boxes
    problem.options.voxel_size = {0, 0, 0};
    problem.scene.n_large = static_cast<std::int32_t>(seed % 4);
  } else {
    problem.options.voxel_size = {size, size, 2 * size};
  }
  problem.options.rules.touching = seed % 11 < 7 ? Touching::counts : Touching::does_not_count;
  problem.options.rules.within_model =
      problem.scene.n_models == 1 || seed % 13 < 4 ? WithinModel::test : WithinModel::skip;
  if (seed % 6 == 5) problem.only = ModelId{0};
  return problem;
}

void check_reports(Problem problem) {
  REQUIRE(problem.rounds.size() == kRounds);
  REQUIRE(problem.n_left == 0);
  for (std::int32_t round = 0; round < kRounds; ++round) {
    Scene scene = problem.scene;
    scene.round = round;
    const Reports expected = oracle(scene, problem.options.rules, problem.only);
    CAPTURE(round);
    REQUIRE(problem.rounds[static_cast<std::size_t>(round)].size() == expected.size());
    REQUIRE((problem.rounds[static_cast<std::size_t>(round)] == expected));
  }
}

/// Runs the program of each seed on a simulated machine, then `judge`.
void on_many_schedules(std::uint64_t n_seeds, Task (*program)(Problem&),
                       const std::function<void(Problem)>& judge) {
  test::for_seeds(1, test::n_seeds(n_seeds) + 1, [&](std::uint64_t seed) {
    // Every other machine has a PE per process, so that all messages are packed.
    const test::Machine machine{.pes = std::array{1, 2, 3, 4, 8}[seed % 5],
                                .per_process = seed / 5 % 2 == 0 ? 1 : 0,
                                .seed = seed,
                                .migration = 0.1};
    Problem problem = problem_of(seed);
    machine.run([&] { return program(problem); }).require_success();
    judge(std::move(problem));
  });
}

}  // namespace

TEST_CASE("each pair is reported once to each owner in any order of delivery and under migration",
          "[collide][parallel]") {
  on_many_schedules(250, &collide_rounds, &check_reports);
}

TEST_CASE("each pair is reported once to each owner on threads", "[collide][parallel]") {
  for (const int pes : {1, 2, 4})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      Problem problem = problem_of(seed);
      CAPTURE(pes, seed);
      REQUIRE(run_with(fmt::format("--pes={}", pes), problem, &collide_rounds) == 0);
      check_reports(std::move(problem));
    }
}

TEST_CASE("collisions of two colliders, and of one, may overlap", "[collide][parallel]") {
  on_many_schedules(60, &collide_overlapping, [](Problem problem) {
    const Reports once = oracle(problem.scene, problem.options.rules, problem.only);
    Reports expected;
    for (int i = 0; i < 2; ++i) expected.insert(expected.end(), once.begin(), once.end());
    REQUIRE((problem.rounds.front() == in_order(std::move(expected))));
  });
}

TEST_CASE("collisions of one collider overlap when the objects of the one before are taken",
          "[collide][parallel]") {
  on_many_schedules(60, &collide_in_a_row, [](Problem problem) {
    Reports expected;
    for (problem.scene.round = 0; problem.scene.round < kOverlapping; ++problem.scene.round) {
      const Reports round = oracle(problem.scene, problem.options.rules, problem.only);
      expected.insert(expected.end(), round.begin(), round.end());
    }
    REQUIRE((problem.rounds.front() == in_order(std::move(expected))));
  });
}

TEST_CASE("objects are submitted in the epoch that creates the collider", "[collide][parallel]") {
  test::for_seeds(1, 1 + test::n_seeds(60), [&](std::uint64_t seed) {
    Problem problem;
    problem.scene = {.seed = seed, .n_clients = 5, .n_boxes = 20, .n_models = 1};
    problem.options.rules.within_model = WithinModel::test;
    problem.options.slack = seed % 3 == 0 ? 0.1 : 0;
    const test::Machine machine{
        .pes = 4, .per_process = seed % 2 == 0 ? 1 : 0, .seed = seed, .migration = 0.1};
    machine.run([&] { return collide_early(problem); }).require_success();
    REQUIRE((problem.rounds.front() == oracle(problem.scene, problem.options.rules, {})));
    REQUIRE_FALSE(problem.rounds.front().empty());
  });
}

TEST_CASE("nothing is sent for one model, and voxels of one model alone are not made",
          "[collide][parallel]") {
  for (const std::string option : {"--pes=1", "--pes=2", "--sim=pes=3,cost=100ns,seed=5"}) {
    Problem problem;
    problem.scene = {.seed = 4, .n_clients = 3, .n_boxes = 40, .n_models = 1};
    problem.options.rules.within_model = WithinModel::skip;
    problem.options.voxel_size = {1, 1, 1};
    CAPTURE(option);
    REQUIRE(run_with(option, problem, &collide_apart) == 0);
    REQUIRE(problem.n_sent_of_one_model == 0);
    // Two far objects of another model: their voxel and the others are left out.
    REQUIRE(problem.n_sent_of_two_models == 0);
    REQUIRE(problem.rounds.front().empty());
  }
}

TEST_CASE("a collision counts the voxels and the objects in them as a serial search does",
          "[collide][parallel]") {
  for (const WithinModel within : {WithinModel::skip, WithinModel::test}) {
    Problem problem;
    problem.scene.n_clients = 1;
    problem.options.voxel_size = {1, 2, 3};
    problem.options.rules.within_model = within;
    REQUIRE(run_with("--sim=pes=3,cost=100ns,seed=5", problem, &count_grid) == 0);
    CHECK(problem.grid.voxel_size == 3);
    CHECK(problem.grid.n_levels == 1);
    CHECK(problem.grid.n_voxels == (within == WithinModel::skip ? 2 : 3));
    CHECK(problem.grid.n_entries == 7);
    CHECK(problem.grid.n_left_out == (within == WithinModel::skip ? 3 : 1));
  }
}

TEST_CASE("voxels too small for 32-bit cells are refused, and the collider goes on",
          "[collide][parallel]") {
  for (const std::string option : {"--pes=2", "--sim=pes=3,cost=100ns,seed=5"}) {
    Problem problem;
    problem.scene = {.seed = 3, .n_clients = 3, .n_boxes = 40, .n_models = 2};
    problem.options.voxel_size = {1e-10, 1e-10, 1e-10};
    CAPTURE(option);
    REQUIRE(run_with(option, problem, &collide_refused) == 0);
    REQUIRE_THAT(problem.error, Contains("has no 32-bit cell at voxel size 1e-10"));
    REQUIRE(problem.rounds.front().empty());
  }
}

TEST_CASE("a list with a NaN box is refused as a whole, before any message is sent",
          "[collide][parallel]") {
  for (const std::string option : {"--pes=1", "--pes=2", "--sim=pes=3,cost=100ns,seed=5"}) {
    Problem problem = problem_of(5);
    CAPTURE(option);
    REQUIRE(run_with(option, problem, &collide_bad) == 0);
    REQUIRE(problem.n_refused == problem.scene.n_clients);
    REQUIRE(problem.rounds.front().empty());
    REQUIRE(problem.n_left_out == 0);
    // The others stand if the collider is told so.
    problem.options.invalid_boxes = tess::collide::InvalidBoxes::leave_out;
    problem.rounds.clear();
    REQUIRE(run_with(option, problem, &collide_bad) == 0);
    REQUIRE(problem.n_refused == 0);
    REQUIRE(problem.n_left_out == problem.scene.n_clients);
    REQUIRE_FALSE(problem.rounds.front().empty());
    const auto bad = static_cast<tess::collide::LocalId>(problem.scene.n_boxes - 1);
    for (const auto& reported : problem.rounds.front())
      REQUIRE((reported.pair.mine != bad && reported.pair.theirs != bad));
  }
}
