// Colliders with a slack: boxes that move little, far, or not at all, whose owners migrate and
// change what they submit, against all pairs in each step; when pairs are kept; and which input is
// refused.
#include "collide/collider.hpp"
#include "collide/parallel/kept_pairs.hpp"
#include "collide/parallel/plan.hpp"
#include "runtime/balance.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/reported_pairs.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tess;
using namespace tess::collide;

constexpr double slack = 0.05;

struct Moving {
  std::uint64_t seed = 0;
  std::int32_t n_clients = 3;
  std::uint32_t n_boxes = 30;  ///< per client
  std::uint32_t n_models = 2;
  double drift = 0.01;              ///< how far a box moves in a step, at most, on each axis
  std::int32_t jump = -1;           ///< in this step one box is elsewhere
  std::int32_t birth = -1;          ///< from this step on a client has one more box
  std::int32_t other_numbers = -1;  ///< from this step on, for the same boxes
  std::int32_t other_models = -1;
  bool identical = false;  ///< all boxes are
  bool with_capsules = false;
  double scale = 1, voxel_size = 0;
  PairRules rules{};
  std::optional<ModelId> only{};

  template <class Ar>
  void serialize(Ar& ar) {
    ar(seed, n_clients, n_boxes, n_models, drift, jump, birth, other_numbers, other_models,
       identical, with_capsules, scale, voxel_size, rules, only);
  }
};

/// The boxes of a client in a step. On a lattice in half of the scenes, so that boxes touch.
std::vector<Item> items_of(const Moving& scene, std::int32_t client, std::int32_t step) {
  const bool has_last = scene.birth >= 0 && step >= scene.birth && client == 0;
  const std::uint32_t n = scene.n_boxes + (has_last ? 1U : 0U);
  const bool renumbered = scene.other_numbers >= 0 && step >= scene.other_numbers;
  const std::uint64_t shift = scene.other_models >= 0 && step >= scene.other_models ? 1 : 0;
  std::vector<Item> items(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    Random random(mix(scene.seed ^ mix(static_cast<std::uint64_t>(client) << 32 | i)));
    items[i].id = {
        owner_of(Index1{client}), LocalId{renumbered ? 100 + i : i},
        static_cast<ModelId>((random.below(scene.n_models) + shift * i) % scene.n_models)};
    const bool jumps = step == scene.jump && client == 0 && i == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      double lo = 3 * random.unit() + (jumps ? 0.7 : 0), extent = random.unit();
      if (scene.seed % 2 == 0) lo = std::round(8 * lo) / 8, extent = std::round(8 * extent) / 8;
      if (scene.identical) lo = 0, extent = 1;
      lo += scene.drift * (2 * random.unit() - 1) * (step % 4);
      items[i].box.lo[k] = scene.scale * lo;
      items[i].box.hi[k] = scene.scale * (lo + extent);
    }
  }
  return items;
}

using test::in_order, test::Reports;

Reports all_pairs(const Moving& scene, std::int32_t step) {
  std::vector<Item> all;
  for (std::int32_t c = 0; c < scene.n_clients; ++c)
    for (const Item& item : items_of(scene, c, step)) all.push_back(item);
  return test::all_reports(all, scene.rules, scene.only);
}

class Mover : public Chare<Mover> {
 public:
  explicit Mover(const Moving& scene) : scene_(scene) {}

  void submit(const Collider& collider, std::int32_t step) {
    const std::vector<Item> items = items_of(scene_, index().x, step);
    std::vector<Capsule> capsules;
    if (scene_.with_capsules) capsules.resize(items.size(), unknown_capsule);
    try {
      collider.submit(items, capsules);
    } catch (const Error& error) {
      refused_ = error.what();
    }
  }
  void receive(const Hits& hits) {
    TESS_CHECK(hits.owner == owner_of(index()), "hits of another owner");
    test::add(received_, hits);
  }
  /// Of the steps since the last call.
  void give(Callback<Reports> target) {
    contribute(concatenate, std::exchange(received_, {}), std::move(target));
  }
  void give_refused(Callback<std::string> target) { contribute(max, refused_, std::move(target)); }
  Task collide(Collider collider, HitReceivers to, Callback<void> taken) {
    co_await collider.run(to, taken);
  }
  /// The boxes of a step are submitted as soon as those of the one before are taken.
  Task collide_in_a_row(Collider collider, HitReceivers to, std::int32_t n_steps) {
    for (std::int32_t step = 0; step < n_steps; ++step) {
      co_await epoch([&] { array().broadcast<&Mover::submit>(collider, step); });
      Future<void> taken;
      array()[{step % scene_.n_clients}].send<&Mover::collide>(collider, to, taken.callback());
      co_await taken;
    }
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(scene_, received_, refused_);
  }
  Mover() = default;

 private:
  Moving scene_;
  Reports received_;
  std::string refused_;
};

struct Outcome {
  std::vector<Reports> steps;
  std::vector<CollisionStatistics> statistics;
  std::string refused;
  std::size_t n_left = 0;
};

struct Movers {
  Collider collider;
  ArrayProxy<Mover> clients;
  HitReceivers receivers;
};

Task begin(const Moving& scene, const ColliderOptions& options, Movers& out) {
  co_await epoch([&] {
    out.collider = make_collider(options);
    out.clients = create<Mover>(range(scene.n_clients), scene);
  });
  out.receivers = {report_to<&Mover::receive>(out.clients), scene.only};
}

Task give_all(const Movers& movers, Outcome& outcome) {
  outcome.steps.push_back(in_order(co_await movers.clients.reduce<&Mover::give>()));
}

Task end(const Movers& movers, Outcome& outcome) {
  outcome.refused = co_await movers.clients.reduce<&Mover::give_refused>();
  co_await epoch([&] {
    movers.collider.destroy();
    movers.clients.destroy();
  });
  outcome.n_left = current_pe().collections().all().size();
}

ColliderOptions with_slack(const Moving& scene) {
  const double size = scene.voxel_size;
  return {.voxel_size = {size, size, size}, .rules = scene.rules, .slack = slack * scene.scale};
}

Task collide_steps(const Moving& scene, std::int32_t n_steps, Outcome& outcome) {
  Movers movers;
  co_await begin(scene, with_slack(scene), movers);
  for (std::int32_t step = 0; step < n_steps; ++step) {
    co_await epoch([&] { movers.clients.broadcast<&Mover::submit>(movers.collider, step); });
    co_await movers.collider.run(movers.receivers);
    co_await give_all(movers, outcome);
    outcome.statistics.push_back(co_await movers.collider.statistics());
  }
  co_await end(movers, outcome);
}

Task collide_in_a_row(const Moving& scene, std::int32_t n_steps, Outcome& outcome) {
  Movers movers;
  co_await begin(scene, with_slack(scene), movers);
  co_await epoch([&] {
    movers.clients[{0}].send<&Mover::collide_in_a_row>(movers.collider, movers.receivers, n_steps);
  });
  co_await give_all(movers, outcome);
  co_await end(movers, outcome);
}

/// In two colliders, while the voxels of the first are balanced.
Task collide_two_at_once(const std::array<Moving, 2>& scenes, std::int32_t n_steps,
                         std::array<Outcome, 2>& outcomes) {
  std::array<Movers, 2> movers;
  for (std::size_t i = 0; i < 2; ++i) co_await begin(scenes[i], with_slack(scenes[i]), movers[i]);
  const BalancerProxy voxels = start_balancing(movers[0].collider.voxels, {.strategy = "rotate"});
  for (std::int32_t step = 0; step < n_steps; ++step) {
    co_await epoch([&] {
      for (const Movers& one : movers) one.clients.broadcast<&Mover::submit>(one.collider, step);
    });
    Task first = movers[0].collider.run(movers[0].receivers);
    Task second = movers[1].collider.run(movers[1].receivers), round = voxels.round();
    co_await first;
    co_await second;
    co_await round;
    for (std::size_t i = 0; i < 2; ++i) co_await give_all(movers[i], outcomes[i]);
  }
  for (std::size_t i = 0; i < 2; ++i) co_await end(movers[i], outcomes[i]);
}

Moving scene_of(std::uint64_t seed) {
  Moving scene{.seed = seed,
               .n_clients = static_cast<std::int32_t>(1 + seed % 6),
               .n_boxes = static_cast<std::uint32_t>(10 + seed % 3 * 15),
               .n_models = static_cast<std::uint32_t>(1 + seed % 3)};
  scene.drift = std::array{0.0, 0.01, 0.016, 0.03, 0.3}[seed / 2 % 5];
  scene.scale = std::array{1.0, 1e-200, 1e100, 1e3}[seed / 3 % 4];
  if (seed % 5 == 3) scene.jump = 2;
  if (seed % 5 == 4) scene.birth = 2;
  if (seed % 7 == 1) scene.other_numbers = 1;
  if (seed % 7 == 2) scene.other_models = 1;
  scene.rules.touching = seed % 7 < 4 ? Touching::counts : Touching::does_not_count;
  scene.rules.within_model =
      scene.n_models == 1 || seed % 11 < 4 ? WithinModel::test : WithinModel::skip;
  if (seed % 6 == 5) scene.only = ModelId{0};
  return scene;
}

test::Machine machine_of(std::uint64_t seed) {
  return {.pes = std::array{1, 2, 3, 4, 8, 20}[seed % 6],
          .per_process = seed / 6 % 2 == 0 ? 1 : 0,
          .seed = seed,
          .migration = seed % 4 == 0 ? 0.1 : 0};
}

bool was_kept(const CollisionStatistics& statistics) {
  return !statistics.searched;
}

}  // namespace

TEST_CASE("with a slack each step reports the pairs of its boxes", "[collide][slack]") {
  constexpr std::int32_t n_steps = 6;
  std::size_t n_kept = 0, n_searched = 0;
  test::for_seeds(1, 1 + test::n_seeds(300), [&](std::uint64_t seed) {
    const Moving scene = scene_of(seed);
    Outcome outcome;
    machine_of(seed).run([&] { return collide_steps(scene, n_steps, outcome); }).require_success();
    for (std::int32_t step = 0; step < n_steps; ++step) {
      CAPTURE(step);
      REQUIRE((outcome.steps.at(static_cast<std::size_t>(step)) == all_pairs(scene, step)));
      ++(was_kept(outcome.statistics[static_cast<std::size_t>(step)]) ? n_kept : n_searched);
    }
    REQUIRE(outcome.n_left == 0);
  });
  REQUIRE(n_kept > n_searched / 4);
  REQUIRE(n_searched > n_kept / 4);
}

TEST_CASE("collisions with a slack may overlap", "[collide][slack]") {
  constexpr std::int32_t n_steps = 5;
  test::for_seeds(1, 1 + test::n_seeds(150), [&](std::uint64_t seed) {
    const Moving scene = scene_of(seed);
    Outcome outcome;
    machine_of(seed)
        .run([&] { return collide_in_a_row(scene, n_steps, outcome); })
        .require_success();
    Reports expected;
    for (std::int32_t step = 0; step < n_steps; ++step)
      for (const test::Reported& one : all_pairs(scene, step)) expected.push_back(one);
    REQUIRE((outcome.steps.at(0) == in_order(std::move(expected))));
  });
}

TEST_CASE("two colliders with a slack do not disturb each other, nor does the balancer of voxels",
          "[collide][slack]") {
  constexpr std::int32_t n_steps = 5;
  test::for_seeds(1, 1 + test::n_seeds(100), [&](std::uint64_t seed) {
    const std::array<Moving, 2> scenes{scene_of(seed), scene_of(seed + 1000)};
    std::array<Outcome, 2> outcomes;
    machine_of(seed)
        .run([&] { return collide_two_at_once(scenes, n_steps, outcomes); })
        .require_success();
    for (std::int32_t step = 0; step < n_steps; ++step) {
      CAPTURE(step);
      for (std::size_t i = 0; i < 2; ++i)
        REQUIRE(
            (outcomes[i].steps.at(static_cast<std::size_t>(step)) == all_pairs(scenes[i], step)));
    }
    REQUIRE(outcomes[1].n_left == 0);
  });
}

TEST_CASE(
    "pairs are kept while each box stays within its larger one, and searched again if one does not",
    "[collide][slack]") {
  for (const bool separate : {false, true}) {
    const test::Machine machine{
        .pes = 4, .per_process = separate ? 1 : 4, .reordering = 0, .migration = 0};
    Moving scene{.seed = 1, .n_clients = 4, .drift = slack / 3 * 0.99};
    const auto kept_in = [&](std::int32_t n_steps) {
      Outcome outcome;
      machine.run([&] { return collide_steps(scene, n_steps, outcome); }).require_success();
      std::string kept;
      for (const CollisionStatistics& s : outcome.statistics) kept += was_kept(s) ? 'k' : 's';
      return kept;
    };
    CHECK(kept_in(5) == "skkkk");
    scene.jump = 2;  // and back
    CHECK(kept_in(5) == "skssk");
    scene.jump = -1, scene.birth = 3;
    CHECK(kept_in(5) == "skksk");
    scene.birth = -1, scene.other_numbers = 2;
    CHECK(kept_in(5) == "skskk");
    scene.other_numbers = -1, scene.other_models = 3;
    CHECK(kept_in(5) == "skksk");
    scene.other_models = -1, scene.drift = slack;  // times 0, 1, 2, 3, 0
    CHECK(kept_in(5) == "sksks");
  }
}

TEST_CASE("on threads pairs are kept", "[collide][slack]") {
  const Moving scene{.seed = 5, .n_clients = 4, .n_boxes = 100, .drift = 0.01};
  Outcome outcome;
  REQUIRE(tests::run_threads(2, [&] { return collide_steps(scene, 6, outcome); }).exit_code == 0);
  for (std::int32_t step = 0; step < 6; ++step)
    REQUIRE((outcome.steps.at(static_cast<std::size_t>(step)) == all_pairs(scene, step)));
  REQUIRE(std::count_if(outcome.statistics.begin(), outcome.statistics.end(), &was_kept) >= 1);
}

TEST_CASE("more pairs than are kept are found without keeping them", "[collide][slack]") {
  const Moving scene{.n_clients = 3,
                     .n_boxes = 300,
                     .n_models = 1,
                     .drift = 0,
                     .identical = true,
                     .rules = {.within_model = WithinModel::test}};
  Outcome outcome;
  const test::Machine machine{.pes = 3, .seed = 3, .migration = 0};
  machine.run([&] { return collide_steps(scene, 2, outcome); }).require_success();
  for (std::size_t step = 0; step < 2; ++step) {
    REQUIRE((outcome.steps.at(step) == all_pairs(scene, 0)));
    REQUIRE(outcome.statistics[step].n_kept == 0);
    REQUIRE(outcome.statistics[step].searched);
    REQUIRE(outcome.statistics[step].grid.n_voxels > 0);
  }
}

TEST_CASE("larger boxes with by far too many pairs are not searched", "[collide][slack]") {
  Summary larger;
  larger.n = 1'000'000;
  const auto sample = [&](double extent) {
    larger.sample.clear();
    Random random(3);
    for (int i = 0; i < 4096; ++i) {
      const Point lo{random.unit(), random.unit(), random.unit()};
      larger.sample.push_back({lo, {lo[0] + extent, lo[1] + extent, lo[2] + extent}});
    }
  };
  sample(0.02);  // of a box 64 others, within twice its extent on each axis
  const PairRules all{Touching::counts, WithinModel::test};
  CHECK_FALSE(are_far_too_many(larger, all, 4));
  sample(0.1);  // 8 000
  CHECK(are_far_too_many(larger, all, 4));
  CHECK_FALSE(are_far_too_many(Summary(), all, 4));
  // Pairs within a model are not kept.
  const PairRules across{Touching::counts, WithinModel::skip};
  larger.sample_models.assign(larger.sample.size(), 7);
  larger.sample_models.back() = 8;
  CHECK(are_far_too_many(larger, all, 4));
  CHECK_FALSE(are_far_too_many(larger, across, 4));
  for (std::uint32_t i = 0; i < larger.sample.size(); ++i) larger.sample_models[i] = i % 2;
  CHECK(are_far_too_many(larger, across, 4));

  // The pairs are those of a search without a slack, in this collision and in the next.
  Moving scene{.n_clients = 1,
               .n_boxes = 1800,
               .n_models = 1,
               .identical = true,
               .rules = {.within_model = WithinModel::test}};
  Outcome outcome;
  test::Machine{.pes = 1}.run([&] { return collide_steps(scene, 2, outcome); }).require_success();
  constexpr std::size_t n_pairs = std::size_t{1800} * 1799 / 2;
  for (const Reports& step : outcome.steps) {
    REQUIRE(step.size() == n_pairs);
    REQUIRE(std::adjacent_find(step.begin(), step.end()) == step.end());
  }
}

TEST_CASE("colliders with a slack refuse capsules and coordinates without a cell, and go on",
          "[collide][slack]") {
  const test::Machine machine{.pes = 2, .seed = 3};
  Moving scene{.with_capsules = true};
  Outcome outcome;
  machine.run([&] { return collide_steps(scene, 1, outcome); }).require_success();
  REQUIRE_THAT(outcome.refused, Contains("30 capsules were submitted to a collider with a slack"));
  REQUIRE(outcome.steps.at(0).empty());

  scene.with_capsules = false;
  std::string error;
  Outcome after;
  const auto refused_and_again = [&]() -> Task {
    Movers movers;
    ColliderOptions options = with_slack(scene);
    options.voxel_size = {1e-10, 1e-10, 1e-10};
    co_await begin(scene, options, movers);
    for (int i = 0; i < 2; ++i) {
      error.clear();
      co_await epoch([&] { movers.clients.broadcast<&Mover::submit>(movers.collider, 0); });
      try {
        co_await movers.collider.run(movers.receivers);
      } catch (const Error& caught) {
        error = caught.what();
      }
    }
    co_await movers.collider.run(movers.receivers);  // of nothing
    co_await give_all(movers, after);
    co_await end(movers, after);
  };
  machine.run(refused_and_again).require_success();
  REQUIRE_THAT(error, Contains("has no 32-bit cell at voxel size 1e-10"));
  REQUIRE(after.steps.at(0).empty());
}

TEST_CASE("boxes whose larger ones have no cells collide as without a slack", "[collide][slack]") {
  Moving scene{.seed = 3, .drift = 0};
  double highest = 0;
  for (std::int32_t c = 0; c < scene.n_clients; ++c)
    for (const Item& item : items_of(scene, c, 0))
      for (const double x : item.box.hi) highest = std::max(highest, x);
  scene.voxel_size = highest / 2147483000;  // the last cell is 2147483647
  Outcome outcome;
  test::Machine{.pes = 2, .seed = 3}
      .run([&] { return collide_steps(scene, 2, outcome); })
      .require_success();
  for (std::size_t step = 0; step < 2; ++step) {
    REQUIRE_FALSE(outcome.steps.at(step).empty());
    REQUIRE((outcome.steps.at(step) == all_pairs(scene, 0)));
    REQUIRE(outcome.statistics[step].n_kept == 0);
    // The boxes are larger than voxels of this size, so theirs are 8^level times as large.
    const double scale = outcome.statistics[step].grid.voxel_size / scene.voxel_size;
    REQUIRE((scale == std::exp2(std::ilogb(scale)) && std::ilogb(scale) % 3 == 0));
  }
}

TEST_CASE("a slack is a length", "[collide][slack]") {
  for (const double wrong :
       {-1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    const std::string error = tests::error_of("pes=1", [&]() -> Task {
      static_cast<void>(make_collider({.slack = wrong}));
      co_return;
    });
    REQUIRE_THAT(error, Contains("give a positive length, or 0 to search"));
  }
}

TEST_CASE("a larger box contains the box, whatever is rounded", "[collide][slack]") {
  constexpr double most = std::numeric_limits<double>::max();
  for (const double at : {0.0, 1.0, -1e12, 1e300, most, -most})
    for (const double by : {0.0, 1e-300, 1e-9, 1.0, 1e300, most}) {
      const Aabb box{{at, at, at}, {at, at, at}}, larger = larger_box(box, by);
      REQUIRE(is_valid(larger));
      REQUIRE(larger.lo[0] <= at);
      REQUIRE(at <= larger.hi[2]);
      REQUIRE(merged(larger, box) == larger);
    }
}
