// Long thin objects on chares: what is divided, what is left out, and which input is refused.
#include "collide/collider.hpp"
#include "collide/pairs.hpp"
#include "collide/parallel/object_list.hpp"
#include "collide/problem/thin_objects.hpp"
#include "collide/triangle.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace {

using namespace tess;
using namespace tess::collide;

constexpr std::int32_t n_clients = 4;
constexpr double whole = std::numeric_limits<double>::infinity();

/// Triangles of a client, in all directions in the unit cube.
std::vector<Triangle> triangles_of(std::int32_t client, std::size_t n, double length,
                                   double width) {
  Random random(mix(static_cast<std::uint64_t>(client) + 1));
  std::vector<Triangle> out(n);
  for (Triangle& t : out)
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = random.unit();
      t.corners[0][k] = at;
      t.corners[1][k] = at + length * (2 * random.unit() - 1);
      t.corners[2][k] = at + width * (2 * random.unit() - 1);
    }
  return out;
}

struct NeedleScene {
  std::size_t n = 0;  ///< per client
  double length = 0, width = 0;
  bool with_capsules = true;
  ColliderOptions options{};
};

struct NeedlePairs {
  std::vector<std::uint64_t> pairs;  ///< that intersect, in order
  std::uint64_t n_hits = 0;
  CollisionStatistics statistics;
};

std::uint64_t number_of(OwnerId owner, LocalId local) {
  return static_cast<std::uint64_t>(owner) << 16 | static_cast<std::uint64_t>(local);
}

class NeedleOwner : public Chare<NeedleOwner> {
 public:
  explicit NeedleOwner(const NeedleScene& setting) : setting_(setting) {}

  void submit(const Collider& collider) {
    const auto mine = triangles(index().x);
    std::vector<Aabb> boxes;
    for (const Triangle& t : mine) boxes.push_back(box_of(t));
    const auto capsules = setting_.with_capsules ? thin_capsules_of(std::span<const Triangle>(mine))
                                                 : std::vector<Capsule>();
    collider.submit(Objects{owner_of(index()), {}, boxes, {}, capsules});
  }
  void receive(const Hits& hits) {
    const auto mine = triangles(index().x), theirs = triangles(index_of(hits.other).x);
    for (const LocalPair& pair : hits.pairs) {
      ++n_hits_;
      if (!intersect(mine[static_cast<std::size_t>(pair.mine)],
                     theirs[static_cast<std::size_t>(pair.theirs)], Touching::counts))
        continue;
      const std::uint64_t a = number_of(hits.owner, pair.mine),
                          b = number_of(hits.other, pair.theirs);
      pairs_.push_back(std::min(a, b) << 32 | std::max(a, b));
    }
  }
  void give_pairs(Callback<std::vector<std::uint64_t>> target) {
    contribute(concatenate, pairs_, std::move(target));
  }
  void give_hits(Callback<std::uint64_t> target) { contribute(sum, n_hits_, std::move(target)); }

  [[nodiscard]] std::vector<Triangle> triangles(std::int32_t client) const {
    return triangles_of(client, setting_.n, setting_.length, setting_.width);
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(setting_, pairs_, n_hits_);
  }
  NeedleOwner() = default;

 private:
  NeedleScene setting_;
  std::vector<std::uint64_t> pairs_;
  std::uint64_t n_hits_ = 0;
};

Task collide_needles(NeedleScene setting, NeedlePairs& outcome) {
  setting.options.rules.within_model = WithinModel::test;
  Collider collider;
  ArrayProxy<NeedleOwner> clients;
  co_await epoch([&] {
    collider = make_collider(setting.options);
    clients = create<NeedleOwner>(range(n_clients), setting);
  });
  co_await epoch([&] { clients.broadcast<&NeedleOwner::submit>(collider); });
  const HitReceivers to{report_to<&NeedleOwner::receive>(clients), {}, Receivers::one_owner};
  co_await collider.run(to);
  outcome.pairs = co_await clients.reduce<&NeedleOwner::give_pairs>();
  std::sort(outcome.pairs.begin(), outcome.pairs.end());
  outcome.n_hits = co_await clients.reduce<&NeedleOwner::give_hits>();
  outcome.statistics = co_await collider.statistics();
}

NeedlePairs outcome_of(const NeedleScene& setting, const test::Machine& machine) {
  NeedlePairs outcome;
  machine.run([&] { return collide_needles(setting, outcome); }).require_success();
  return outcome;
}

constexpr NeedleScene needles{.n = 1000, .length = 0.5, .width = 1e-4};
/// Two PEs in each of two processes.
const test::Machine two_processes{.pes = 4, .per_process = 2, .seed = 7, .migration = 0.1};

/// Of all clients' triangles.
std::vector<std::uint64_t> oracle(const NeedleScene& setting) {
  std::vector<Triangle> all;
  for (std::int32_t c = 0; c < n_clients; ++c) {
    const auto more = triangles_of(c, setting.n, setting.length, setting.width);
    all.insert(all.end(), more.begin(), more.end());
  }
  const auto number = [&](std::size_t i) {
    const auto client = static_cast<std::int32_t>(i / setting.n);
    return number_of(owner_of(Index1{client}), static_cast<LocalId>(i % setting.n));
  };
  std::vector<std::uint64_t> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      if (intersect(all[i], all[j], Touching::counts)) out.push_back(number(i) << 32 | number(j));
  return out;
}

}  // namespace

TEST_CASE("long thin triangles are searched in pieces, and few of their boxes' pairs are reported",
          "[collide][parallel][pieces]") {
  const std::vector<std::uint64_t> expected = oracle(needles);
  REQUIRE_FALSE(expected.empty());
  NeedleScene as_boxes = needles;
  as_boxes.with_capsules = false;
  const NeedlePairs boxes = outcome_of(as_boxes, two_processes),
                    pieces = outcome_of(needles, two_processes);
  CHECK(boxes.pairs == expected);
  CHECK(boxes.statistics.n_pieces == 0);
  CHECK(pieces.pairs == expected);
  CHECK(pieces.n_hits < boxes.n_hits / 10);
  CHECK(pieces.statistics.n_pieces > n_clients * needles.n);
}

TEST_CASE("pieces of any length find each pair once, in any order of delivery",
          "[collide][parallel][pieces]") {
  NeedleScene setting{.n = 80, .length = 0.9, .width = 0.02};
  const std::vector<std::uint64_t> expected = oracle(setting);
  REQUIRE(expected.size() > 10);
  test::for_seeds(1, 1 + test::n_seeds(40), [&](std::uint64_t seed) {
    setting.options.piece_length = std::array{whole, 0.5, 0.1, 0.02, 1e-6}[seed % 5];
    const double size = std::array{0.0, 0.2, 0.05}[seed % 3];
    setting.options.voxel_size = {size, size, size};
    const NeedlePairs outcome = outcome_of(
        setting, {.pes = 4, .per_process = seed % 2 == 0 ? 1 : 0, .seed = seed, .migration = 0.1});
    const std::uint64_t n = n_clients * setting.n;
    REQUIRE(outcome.pairs == expected);
    REQUIRE((setting.options.piece_length == whole) == (outcome.statistics.n_pieces == n));
    REQUIRE(outcome.statistics.n_pieces <= 64 * n);
  });
}

TEST_CASE("a voxel size that is given leaves objects with capsules whole",
          "[collide][parallel][pieces]") {
  NeedleScene setting = needles;
  setting.options.voxel_size = {0.1, 0.1, 0.1};
  const NeedlePairs outcome = outcome_of(setting, two_processes);
  CHECK(outcome.pairs == oracle(needles));
  CHECK(outcome.statistics.n_pieces == n_clients * needles.n);
}

TEST_CASE("objects that are not thin have no capsules", "[collide][parallel][pieces]") {
  const NeedleScene thick{.n = 100, .length = 0.2, .width = 0.2};
  const NeedlePairs outcome = outcome_of(thick, two_processes);
  CHECK(outcome.pairs == oracle(thick));
  CHECK(outcome.statistics.n_pieces == 0);
}

namespace {

/// Two owners with an object each.
struct TwoObjects {
  std::array<Aabb, 2> boxes;
  std::array<Capsule, 2> capsules;
};

class OwnerOfOne : public Chare<OwnerOfOne> {
 public:
  void submit(const Collider& collider, const TwoObjects& all) {
    const auto me = static_cast<std::size_t>(index().x);
    collider.submit(Objects{owner_of(index()),
                            ModelId{static_cast<std::uint32_t>(me)},
                            std::span(all.boxes).subspan(me, 1),
                            {},
                            std::span(all.capsules).subspan(me, 1)});
  }
  void receive(const Hits& hits) { n_ += static_cast<std::int64_t>(hits.pairs.size()); }
  void give(Callback<std::int64_t> target) { contribute(sum, n_, std::move(target)); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_);
  }

 private:
  std::int64_t n_ = 0;
};

/// How often each owner receives the pair of the objects, in sum.
std::int64_t n_received(const TwoObjects& objects, const ColliderOptions& options) {
  std::int64_t n = 0;
  const auto program = [&]() -> Task {
    Collider collider;
    ArrayProxy<OwnerOfOne> owners;
    co_await epoch([&] {
      collider = make_collider(options);
      owners = create<OwnerOfOne>(range(2));
    });
    co_await epoch([&] { owners.broadcast<&OwnerOfOne::submit>(collider, objects); });
    const HitReceivers to{report_to<&OwnerOfOne::receive>(owners), {}};
    co_await collider.run(to);
    n = co_await owners.reduce<&OwnerOfOne::give>();
  };
  test::Machine{.pes = 2, .per_process = 1, .seed = 3}.run(program).require_success();
  return n;
}

}  // namespace

TEST_CASE("boxes of pieces that only touch are pieces of objects that may overlap",
          "[collide][parallel][pieces]") {
  TwoObjects objects{{{{{0, 0, 0}, {2, 1, 1}}, {{0, 0, 0}, {3, 1, 1}}}},
                     {{{{0, 0.5, 0.5}, {2, 0.5, 0.5}, 0.1}, {{0, 0.5, 0.5}, {3, 0.5, 0.5}, 0.1}}}};
  std::array<Aabb, search::most_pieces> pieces;
  search::cut(objects.boxes[0], objects.capsules[0], 2, pieces.data());
  // The second object touches the first piece of the first one, and overlaps the second one.
  objects.boxes[1].lo[0] = objects.capsules[1].from[0] = pieces[0].hi[0];
  CHECK(n_received(objects, {.rules = {.touching = Touching::does_not_count}, .piece_length = 1}) ==
        2);
}

TEST_CASE("a piece that is a little larger than its level allows is searched",
          "[collide][parallel][pieces]") {
  // Pieces are .5 long, and some roundings; levels 0 and 1 have objects up to .0625 and .5.
  const Capsule capsule{{0, 0, 0}, {7, 0, 0}, 0.03125 - 0x1p-55};
  const Aabb box{{-0.1, -0.1, -0.1}, {7.1, 0.1, 0.1}};
  std::array<Aabb, search::most_pieces> pieces;
  search::cut(box, capsule, 16, pieces.data());
  REQUIRE(pieces[8].hi[0] - pieces[8].lo[0] > 0.5);
  CHECK(n_received({{box, box}, {capsule, capsule}},
                   {.voxel_size = {0.03125, 0.03125, 0.03125}, .piece_length = 0.4375}) == 2);
}

TEST_CASE("an object whose capsule is no capsule is found by its box",
          "[collide][parallel][pieces]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Aabb box{{0, 0, 0}, {8, 1, 1}}, above{{0, 0.9, 0}, {0.5, 1, 1}};
  for (const Capsule& capsule :
       {Capsule{{0, 0, 0.5}, {8, nan, 0.5}, 0.01}, Capsule{{0, 0, 0.5}, {8, 0, 0.5}, -1},
        Capsule{{0, 0, 0.5}, {8, 0, 0.5}, nan}})
    CHECK(n_received({{box, above}, {capsule, unknown_capsule}}, {.piece_length = 1}) == 2);
  // Of a capsule that is one, the pair is too far away.
  const Capsule low{{0, 0, 0.5}, {8, 0, 0.5}, 0.01};
  CHECK(n_received({{box, above}, {low, unknown_capsule}}, {.piece_length = 1}) == 0);
}

TEST_CASE("capsules are none or one per object, and pieces have a length",
          "[collide][parallel][pieces]") {
  const std::vector<Aabb> boxes(3, Aabb{{0, 0, 0}, {1, 1, 1}});
  const std::vector<Capsule> capsules(2, Capsule{{0, 0, 0}, {1, 1, 1}, 1});
  ObjectList list;
  CHECK_THROWS_WITH(list.append(Objects{{}, {}, boxes, {}, capsules}, PeId{0}),
                    Contains("2 capsules were submitted with 3 objects"));
  const std::vector<Item> items{{boxes[0], {}}};
  CHECK_THROWS_WITH(list.append(items, capsules, PeId{0}),
                    Contains("2 capsules were submitted with 1 objects"));
  CHECK_THROWS_WITH(list.append(Objects{{}, {}, {}, {}, capsules}, PeId{0}),
                    Contains("2 capsules were submitted with 0 objects"));
  CHECK_THROWS_WITH(list.append(std::span<const Item>(), capsules, PeId{0}),
                    Contains("2 capsules were submitted with 0 objects"));
  CHECK(list.size() == 0);
  for (const double length : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_WITH(make_collider({.piece_length = length}),
                      Contains("give a positive length, infinity for whole objects"));
}
