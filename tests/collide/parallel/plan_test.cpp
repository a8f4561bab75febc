// The plan of a collision: the voxels that it chooses.
#include "collide/parallel/plan.hpp"

#include "collide/pairs.hpp"
#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace tess::collide {
namespace {

/// A sheet of n × n boxes that touch their neighbours.
std::vector<Aabb> sheet(int n) {
  std::vector<Aabb> boxes;
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y) boxes.push_back({{1.0 * x, 1.0 * y, 0}, {x + 1.0, y + 1.0, 0}});
  return boxes;
}

/// Cubes in a unit cube.
std::vector<Aabb> crowd(std::size_t n, double edge) {
  std::uint64_t drawn = 0;
  const auto draw = [&] { return static_cast<double>(mix(++drawn) >> 11) * 0x1p-53 * (1 - edge); };
  std::vector<Aabb> boxes(n);
  for (Aabb& box : boxes)
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = draw();
      box.hi[k] = box.lo[k] + edge;
    }
  return boxes;
}

/// The plan for boxes that are spread over some PEs.
Plan plan_of(const std::vector<Aabb>& boxes, std::int32_t n_pes) {
  Summary all;
  for (std::size_t pe = 0; pe < static_cast<std::size_t>(n_pes); ++pe) {
    const std::size_t pes = static_cast<std::size_t>(n_pes);
    const std::size_t begin = boxes.size() * pe / pes, end = boxes.size() * (pe + 1) / pes;
    ObjectList objects;
    objects.append(Objects{.boxes = std::span(boxes).subspan(begin, end - begin)},
                   PeId{static_cast<std::int32_t>(pe)});
    all = JoinSummaries{}.combine(std::move(all), Summary(objects, static_cast<std::int32_t>(pe),
                                                          n_sampled_per_pe({}, n_pes)));
  }
  const Plan plan = make_plan(JoinSummaries{}.finish(std::move(all)), n_pes,
                              {.rules = {.within_model = WithinModel::test}}, 1);
  REQUIRE_FALSE(plan.nothing);
  return plan;
}

/// The objects per voxel that is chosen for a sheet of n × n boxes.
double objects_per_voxel(int n, std::int32_t n_pes) {
  const Plan plan = plan_of(sheet(n), n_pes);
  return plan.size[0] * plan.size[1];
}

}  // namespace

// How many that are depends on the width of the processor's vectors.
TEST_CASE("a voxel on chares has enough objects to be worth its messages", "[collide][parallel]") {
  PairStatistics serial;
  (void)count_pairs(std::span<const Aabb>(sheet(512)), {.statistics = &serial});
  const double n = objects_per_voxel(512, 1);
  CAPTURE(serial.grid.voxel_size);
  CHECK(n > 1.5 * serial.grid.voxel_size * serial.grid.voxel_size);
  CHECK(n < 1024);
}

TEST_CASE("on many PEs voxels are smaller, so that each PE has some", "[collide][parallel]") {
  const double one = objects_per_voxel(256, 1), many = objects_per_voxel(256, 2048);
  CHECK(many < one);
  CHECK(256 * 256 / many / 2048 >= 2);
}

// One PE compared 7 000 boxes for .05 s, and 1 023 waited.
TEST_CASE("many PEs do not wait for one that has the only voxel", "[collide][parallel]") {
  for (const double edge : {.03, .06, .1, .2}) {
    CAPTURE(edge);
    const std::vector<Aabb> boxes = crowd(7000, edge);
    double size = 1;
    for (const std::int32_t n_pes : {16, 64, 256, 1024}) {
      CAPTURE(n_pes);
      const Plan plan = plan_of(boxes, n_pes);
      CHECK(plan.size[0] <= size);
      CHECK(n_pes * plan.size[0] * plan.size[0] * plan.size[0] <= 16);
      size = plan.size[0];
    }
  }
}

// In voxels of a twelfth, boxes longer than a sixth stood on a level of eight voxels, and every PE
// waited for the one that compared all others with them.
TEST_CASE("objects over more than the range of a double are refused", "[collide][parallel]") {
  constexpr double most = std::numeric_limits<double>::max();
  const Aabb small{{0, 0, 0}, {1, 1, 1}};
  CHECK(plan_of({small, {{-most / 4, 0, 0}, {most / 4, 1, 1}}}, 2).size[0] > 0);
  CHECK_THROWS_WITH(plan_of({small, {{-most, 0, 0}, {most, 1, 1}}}, 2),
                    Contains("scale them down"));
}

TEST_CASE("objects that are a little too large for the voxels have no level of their own",
          "[collide][parallel]") {
  for (const double edge : {.03, .04, .06, .08, .1, .13, .17, .2})
    for (const double scale : {1., 1.2, 1.4, 1.7}) {
      CAPTURE(edge, scale);
      std::vector<Aabb> boxes = crowd(5000, edge / 4);
      const std::vector<Aabb> large = crowd(500, edge);
      boxes.insert(boxes.end(), large.begin(), large.end());
      for (Aabb& box : boxes)
        for (std::size_t k = 0; k < 3; ++k) {
          box.lo[k] *= scale;
          box.hi[k] *= scale;
        }
      for (const std::int32_t n_pes : {1, 16, 256, 1024}) {
        CAPTURE(n_pes);
        const Plan plan = plan_of(boxes, n_pes);
        CHECK(plan.levels == 1U << plan.level_of(edge * scale));
      }
    }
}

TEST_CASE("objects of the largest extents have voxels", "[collide][parallel]") {
  constexpr double far = 0x1.8p1023;
  const std::vector<Aabb> boxes{{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {far, 1, 1}}};
  ObjectList objects;
  objects.append(Objects{.boxes = boxes}, PeId{0});
  for (const double size : {5e307, 0.}) {
    CAPTURE(size);
    const Plan plan = make_plan(
        Summary(objects, 0, 2), 1,
        {.voxel_size = {size, size, size}, .rules = {.within_model = WithinModel::test}}, 1);
    for (Level level = 0; level < most_levels; ++level)
      if (plan.has(level)) CHECK_NOTHROW(plan.grid(level).cells_of(objects.bounds()));
    CHECK(plan.has(plan.level_of(far)));
  }
}

// Extents below the least normal number are one octave, over which several levels reach.
TEST_CASE("objects of denormal extents have voxels on every level that they may stand on",
          "[collide][parallel]") {
  constexpr double s = 1e-309;
  const std::vector<Aabb> boxes{{{0, 0, 0}, {15 * s, 15 * s, 15 * s}},
                                {{1000 * s, 0, 0}, {1200 * s, 200 * s, 200 * s}}};
  ObjectList objects;
  objects.append(Objects{.boxes = boxes}, PeId{0});
  const Plan plan = make_plan(
      Summary(objects, 0, 0), 1,
      {.voxel_size = {6 * s, 6 * s, 6 * s}, .rules = {.within_model = WithinModel::test}}, 1);
  for (const double extent : {15 * s, 200 * s}) CHECK(plan.has(plan.level_of(extent)));
}

TEST_CASE("a sample has the models of its boxes", "[collide][parallel]") {
  Summary all;
  for (const std::int32_t pe : {2, 0, 1}) {
    std::vector<Item> items;
    for (std::uint32_t i = 0; i < 20; ++i) {
      const auto at = static_cast<double>(100 * pe + 3 * static_cast<int>(i));
      items.push_back({{{at, 0, 0}, {at, 1, 1}}, {{}, {}, static_cast<ModelId>(at)}});
    }
    ObjectList objects;
    objects.append(items, {}, PeId{pe});
    all = JoinSummaries{}.combine(std::move(all), Summary(objects, pe, 7));
  }
  all = JoinSummaries{}.finish(std::move(all));
  REQUIRE(all.sample.size() == 21);
  REQUIRE(all.sample_models.size() == 21);
  for (std::size_t i = 0; i < 21; ++i) CHECK(all.sample[i].lo[0] == all.sample_models[i]);
}

// With the same places on every PE, half of the sample were the first objects.
TEST_CASE("few samples of many PEs are from everywhere in their lists", "[collide][parallel]") {
  std::vector<Aabb> boxes(8);  // one large box, and points
  boxes[0].hi = {1, 1, 1};
  ObjectList objects;
  objects.append(Objects{.boxes = boxes}, PeId{0});
  int n = 0, n_large = 0;
  for (std::int32_t pe = 0; pe < 1024; ++pe)
    for (const Aabb& box : Summary(objects, pe, n_sampled_per_pe({}, 1024)).sample) {
      ++n;
      n_large += box.hi[0] > 0 ? 1 : 0;
    }
  CHECK(n == 2048);
  CHECK(n_large > 0.8 * n / 8);
  CHECK(n_large < 1.2 * n / 8);
}

// All PEs wait for the summaries of all. With eight boxes per PE, 1 500 PEs waited .18 ms.
TEST_CASE("many PEs send small summaries, without boxes if the size of a voxel is given",
          "[collide][parallel]") {
  for (const std::int32_t n_pes : {1, 4, 64, 256, 1024, 1500, 4096}) {
    CAPTURE(n_pes);
    CHECK(n_sampled_per_pe({1, 1, 1}, n_pes) == 0);
    const std::size_t n_each = n_sampled_per_pe({}, n_pes);
    CHECK(n_each >= 2);
    CHECK(n_each * static_cast<std::size_t>(n_pes) <=
          static_cast<std::size_t>(std::max(4096, 2 * n_pes)));
  }
  const std::vector<Aabb> boxes = sheet(4);
  ObjectList objects;
  objects.append(Objects{.boxes = boxes}, PeId{0});
  CHECK(Summary(objects, 0, 0).sample.empty());
  CHECK(Summary(objects, 0, 3).sample.size() == 3);
}

namespace {

/// Diagonals of boxes of this length, of a PE: the capsule of a box begins in its lower corner.
Summary summary_of(std::int32_t pe, std::size_t n, double length, bool with_capsules) {
  Random random(static_cast<std::uint64_t>(pe));
  std::vector<Aabb> boxes(n);
  std::vector<Capsule> capsules(with_capsules ? n : 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      boxes[i].lo[k] = random.unit();
      boxes[i].hi[k] = boxes[i].lo[k] + length;
    }
    if (with_capsules) capsules[i] = {boxes[i].lo, boxes[i].hi, 0};
  }
  ObjectList objects;
  objects.append(Objects{{}, {}, boxes, {}, capsules}, PeId{pe});
  return Summary(objects, pe, 2048);
}

}  // namespace

TEST_CASE("capsules stand beside their boxes in a sample of several PEs",
          "[collide][parallel][pieces]") {
  Summary all =
      JoinSummaries{}.combine(summary_of(2, 50, 0.1, true), summary_of(0, 30, 0.1, false));
  all = JoinSummaries{}.combine(summary_of(3, 20, 0.1, false), std::move(all));
  all =
      JoinSummaries{}.finish(JoinSummaries{}.combine(std::move(all), summary_of(1, 40, 0.1, true)));
  REQUIRE(all.sample.size() == 140);
  REQUIRE(all.capsules.size() == 140);
  for (std::size_t i = 0; i < 140; ++i) {
    CAPTURE(i);
    const bool is_known = i >= 30 && i < 120;  // of PEs 1 and 2
    CHECK(std::isfinite(all.capsules[i].radius) == is_known);
    if (is_known) CHECK(all.capsules[i].from == all.sample[i].lo);
  }
  CHECK(all.largest_radius == std::numeric_limits<double>::infinity());
}

TEST_CASE("pieces have voxels of their size, on levels up to that of the largest",
          "[collide][parallel][pieces]") {
  const ColliderOptions options{.rules = {.within_model = WithinModel::test}};
  const Summary needles = summary_of(0, 20000, 0.2, true);
  const Plan plan = make_plan(needles, 1, options, 1);
  REQUIRE(plan.pieces.used);
  CHECK(plan.pieces.longest < 0.1);
  CHECK(plan.size[0] < make_plan(summary_of(0, 20000, 0.2, false), 1, options, 1).size[0]);
  CHECK(plan.levels == 1);
  // Of objects without capsules nothing is known: they may be as large as any.
  const Summary mixed = JoinSummaries{}.finish(
      JoinSummaries{}.combine(needles, summary_of(1, 10, 100 * plan.size[0], false)));
  ColliderOptions given = options;
  given.voxel_size = plan.size;
  given.piece_length = plan.pieces.longest;
  const Plan of_mixed = make_plan(mixed, 2, given, 1);
  CHECK(of_mixed.highest() == of_mixed.level_of(100 * plan.size[0]));
  CHECK(of_mixed.highest() > 0);
}

}  // namespace tess::collide
