// The tests show which owners receive a pair, and what a simulated machine charges for it.
#include "collide/collider.hpp"
#include "collide/parallel/object_list.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tess;
using namespace tess::collide;

constexpr std::int32_t n_places = 200;

/// Owns `n_each` equal boxes at each place of a row; client c has model c.
class Row : public Chare<Row> {
 public:
  void submit(const Collider& collider, std::array<std::int32_t, 2> n_each) {
    std::vector<Aabb> boxes;
    for (std::int32_t place = 0; place < n_places; ++place)
      for (std::int32_t i = 0; i < n_each[static_cast<std::size_t>(index().x)]; ++i)
        boxes.push_back({{2.0 * place, 0, 0}, {2.0 * place + 1, 1, 1}});
    collider.submit(Objects{owner_of(index()), static_cast<ModelId>(index().x), boxes});
  }
  void receive(const Hits& hits) {
    TESS_CHECK(hits.owner == owner_of(index()), "hits of another owner");
    n_ += static_cast<std::int64_t>(hits.pairs.size());
  }
  void gather(Callback<std::vector<std::int64_t>> target) {
    contribute(concatenate, std::vector{n_}, std::move(target));
  }

 private:
  std::int64_t n_ = 0;
};

/// Returns what the two clients receive. `time` becomes that of the collision.
std::vector<std::int64_t> received(const std::string& option, Receivers receivers,
                                   std::array<std::int32_t, 2> n_each,
                                   const SimulatedCosts& costs = {}, Time* time = nullptr) {
  Setup setup = tests::setup_of(option);
  std::vector<std::int64_t> counts;
  const auto program = [&]() -> Task {
    Collider collider;
    ArrayProxy<Row> rows;
    co_await epoch([&] {
      collider = make_collider({.voxel_size = {4, 4, 4},
                                .rules = {.within_model = WithinModel::skip},
                                .simulated_costs = costs});
      rows = create<Row>(range(2));
    });
    co_await epoch([&] { rows.broadcast<&Row::submit>(collider, n_each); });
    const HitReceivers to{report_to<&Row::receive>(rows), {}, receivers};
    const Time begin = now();
    co_await collider.run(to);
    if (time != nullptr) *time = now() - begin;
    counts = co_await rows.reduce<&Row::gather>();
  };
  REQUIRE(run(setup, [&] { return program(); }) == 0);
  REQUIRE(counts.size() == 2);
  return counts;
}

/// Owns equal boxes, `boxes_of_each[model]` of each model, and keeps its pairs.
class Mixed : public Chare<Mixed> {
 public:
  void submit(const Collider& collider, const std::vector<std::uint32_t>& boxes_of_each) {
    std::uint32_t first = 0;
    for (std::uint32_t model = 0; model < boxes_of_each.size(); ++model) {
      const std::vector<Aabb> boxes(boxes_of_each[model], {{0, 0, 0}, {1, 1, 1}});
      collider.submit(Objects{owner_of(index()), ModelId{model}, boxes, LocalId{first}});
      first += boxes_of_each[model];
    }
  }
  void receive(const Hits& hits) {
    for (const LocalPair& pair : hits.pairs)
      pairs_.push_back({index().x, index_of(hits.other).x, static_cast<std::int32_t>(pair.mine),
                        static_cast<std::int32_t>(pair.theirs)});
  }
  void gather(Callback<std::vector<std::array<std::int32_t, 4>>> target) {
    contribute(concatenate, pairs_, std::move(target));
  }

 private:
  std::vector<std::array<std::int32_t, 4>> pairs_;  // owner, other, mine, theirs
};

/// The pairs that `n_owners` receive of the model `only`, sorted. A pair within an owner has no
/// order unless its objects have two models.
std::vector<std::array<std::int32_t, 4>> of_model(const std::string& option, ModelId only,
                                                  std::int32_t n_owners,
                                                  const std::vector<std::uint32_t>& boxes_of_each,
                                                  double slack) {
  Setup setup = tests::setup_of(option);
  std::vector<std::array<std::int32_t, 4>> pairs;
  const auto program = [&]() -> Task {
    Collider collider;
    ArrayProxy<Mixed> clients;
    co_await epoch([&] {
      collider = make_collider({.rules = {.within_model = WithinModel::test}, .slack = slack});
      clients = create<Mixed>(range(n_owners));
    });
    co_await epoch([&] { clients.broadcast<&Mixed::submit>(collider, boxes_of_each); });
    const HitReceivers to{report_to<&Mixed::receive>(clients), only};
    co_await collider.run(to);
    pairs = co_await clients.reduce<&Mixed::gather>();
  };
  REQUIRE(run(setup, [&] { return program(); }) == 0);
  for (auto& [owner, other, mine, theirs] : pairs)
    if (boxes_of_each.size() == 1 && owner == other && theirs < mine) std::swap(mine, theirs);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

TEST_CASE("the owner of a pair's two objects of the model `only` receives it once",
          "[collide][parallel]") {
  using Pairs = std::vector<std::array<std::int32_t, 4>>;
  for (const double slack : {0.0, 0.1})
    for (const std::string option :
         {"--pes=1", "--pes=2", "--sim=pes=4,seed=1", "--sim=pes=4,per-process=1,seed=2"}) {
      CAPTURE(option, slack);
      CHECK(of_model(option, ModelId{0}, 1, {3}, slack) ==
            Pairs{{0, 0, 0, 1}, {0, 0, 0, 2}, {0, 0, 1, 2}});
      // Each of two owners with an object of the model receives the pair.
      CHECK(of_model(option, ModelId{0}, 2, {1}, slack) == Pairs{{0, 1, 0, 0}, {1, 0, 0, 0}});
      // Of two models, the object of this one is `mine`, and a pair of others is not sent.
      CHECK(of_model(option, ModelId{1}, 1, {2, 1}, slack) == Pairs{{0, 0, 2, 0}, {0, 0, 2, 1}});
      CHECK(of_model(option, ModelId{1}, 1, {2}, slack) == Pairs{});
      CHECK(
          of_model(option, ModelId{1}, 2, {1, 1}, slack) ==
          Pairs{
              {0, 0, 1, 0}, {0, 1, 1, 0}, {0, 1, 1, 1}, {1, 0, 1, 0}, {1, 0, 1, 1}, {1, 1, 1, 0}});
    }
}

TEST_CASE("on request one owner receives a pair: the one of an object of the PE that finds it",
          "[collide][parallel]") {
  for (const std::string option :
       {"--pes=2", "--sim=pes=2,cost=100ns", "--sim=pes=2,per-process=1,cost=100ns"}) {
    CAPTURE(option);
    using Counts = std::vector<std::int64_t>;
    // The PE that has by far more of the objects makes all voxels. (With a seed, the simulated
    // machine moves some of them.)
    CHECK(received(option, Receivers::one_owner, {9, 2}) == Counts{18 * n_places, 0});
    CHECK(received(option, Receivers::one_owner, {2, 9}) == Counts{0, 18 * n_places});
    CHECK(received(option, Receivers::both_owners, {2, 9}) == Counts(2, 18 * n_places));
    const Counts shared = received(option, Receivers::one_owner, {4, 4});
    CHECK(shared[0] + shared[1] == 16 * n_places);
    CHECK(shared[0] > 0);
    CHECK(shared[1] > 0);
  }
}

TEST_CASE("with two owners on one PE, one of them receives a pair on request",
          "[collide][parallel]") {
  for (const Receivers receivers : {Receivers::one_owner, Receivers::both_owners}) {
    const std::vector<std::int64_t> counts = received("--pes=1", receivers, {3, 3});
    CHECK(counts[0] + counts[1] == (receivers == Receivers::one_owner ? 9 : 18) * n_places);
  }
}

TEST_CASE("a simulated PE pays once for each item of each part of a collision",
          "[collide][parallel]") {
  const auto time = [](const std::string& pes, const SimulatedCosts& costs) {
    Time out{};
    (void)received("--sim=cost=100ns,pes=" + pes, Receivers::both_owners, {1, 1}, costs, &out);
    return out.count();
  };
  const auto paid = [&](const SimulatedCosts& costs) { return time("1", costs) - time("1", {}); };
  CHECK(paid({.gridding = 1}) == 2 * n_places);
  CHECK(paid({.search = 1}) == 2 * n_places);
  CHECK(paid({.gridding = 0.5, .pair = 10}) == 11 * n_places);
  CHECK(paid({.reply = 1}) == 2 * n_places);
  // Several PEs copy boxes and compare records, but within a process nothing is copied.
  CHECK(paid({.copy = 1, .record = 1}) == 0);
  CHECK(time("2", {.copy = 1000}) == time("2", {}));
  for (const SimulatedCosts& costs : {SimulatedCosts{.copy = 1000}, SimulatedCosts{.record = 1000}})
    CHECK(time("2,per-process=1", costs) > time("2,per-process=1", {}) + 1000 * n_places / 4);
}

TEST_CASE("objects whose numbers do not fit into 32 bits are refused, and none is accepted",
          "[collide][parallel]") {
  const std::vector<Aabb> boxes(2, Aabb{{0, 0, 0}, {1, 1, 1}});
  ObjectList list;
  CHECK_THROWS_WITH(list.append(Objects{{}, {}, boxes, LocalId{4294967295}}, PeId{0}),
                    "collider: 2 objects numbered from 4294967295 on were submitted; their numbers "
                    "have 32 bits: give a first one of at most 4294967294");
  CHECK(list.size() == 0);
  list.append(Objects{{}, {}, boxes, LocalId{4294967294}}, PeId{0});
  REQUIRE(list.size() == 2);
  CHECK(list.local(1, 0) == LocalId{4294967295});
}

TEST_CASE("a report that nothing receives is refused", "[collide][parallel]") {
  const std::string error = tests::error_of("pes=1", []() -> Task {
    const Collider collider = make_collider({.rules = {.within_model = WithinModel::skip}});
    co_await collider.run({});
  });
  CHECK_THAT(error, Contains("give it report_to<&Client::receive>(clients)"));
}
