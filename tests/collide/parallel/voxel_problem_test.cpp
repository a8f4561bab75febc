// Which sets of a voxel's objects are searched, and when boxes are copied.
#include "collide/parallel/voxel_problem.hpp"

#include "tests/support/catch.hpp"

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace tess::collide {
namespace {

/// A part of one object per model of the list: object i has the box [i, i + 1] on each axis.
Part part_of(std::uint64_t owner, const std::vector<std::uint32_t>& models) {
  auto delivery = std::make_shared<Delivery>();
  for (std::uint32_t i = 0; i < models.size(); ++i) {
    const auto lo = static_cast<double>(i);
    const std::vector<Aabb> boxes{{{lo, lo, lo}, {lo + 1, lo + 1, lo + 1}}};
    delivery->objects.append(
        Objects{static_cast<OwnerId>(owner), ModelId{models[i]}, boxes, LocalId{i}}, PeId{0});
    delivery->sorted.push_back(search::make_entry(i, 0));
  }
  const auto n = static_cast<std::uint32_t>(models.size());
  return Part(delivery, 0, n, 0);
}

std::vector<PairSets> searches_of(VoxelProblem& voxel, const std::vector<Part>& parts,
                                  WithinModel within_model) {
  voxel.gather(parts, within_model);
  std::vector<PairSets> searches;
  voxel.for_each_search([&](const PairSets& sets) { searches.push_back(sets); });
  return searches;
}

/// The owners and numbers of the objects of a set.
std::multiset<std::pair<std::uint64_t, std::uint32_t>> ids_of(
    const ObjectList& list, std::span<const search::Entry> entries) {
  std::multiset<std::pair<std::uint64_t, std::uint32_t>> ids;
  for (const search::Entry entry : entries) {
    const std::uint32_t object = search::object_of(entry), source = list.source(object);
    const auto number = static_cast<std::uint32_t>(list.local(object, source));
    REQUIRE(list.boxes()[object].lo[0] == number);
    ids.emplace(static_cast<std::uint64_t>(list.sources()[source].owner), number);
  }
  return ids;
}

}  // namespace

TEST_CASE("two models in two lists are searched where they are",
          "[collide][parallel][voxel_problem]") {
  const std::vector<Part> parts{part_of(1, {5, 5, 5}), part_of(2, {3, 3})};
  VoxelProblem voxel;
  const auto searches = searches_of(voxel, parts, WithinModel::skip);
  REQUIRE(searches.size() == 1);
  const PairSets& only = searches.front();
  CHECK(only.of_a == &parts[0].delivery().objects);
  CHECK(only.of_b == &parts[1].delivery().objects);
  CHECK(only.problem.boxes_a == only.of_a->boxes().data());
  CHECK(only.problem.a.data() == parts[0].natives().data());
  CHECK(only.problem.b.data() == parts[1].natives().data());
}

TEST_CASE("objects of one model in two lists are copied together, and only those",
          "[collide][parallel][voxel_problem]") {
  const std::vector<Part> parts{part_of(1, {5, 3, 5}), part_of(2, {3, 3})};
  VoxelProblem voxel;
  for (int time = 0; time < 2; ++time) {  // the memory is used again
    const auto searches = searches_of(voxel, parts, WithinModel::skip);
    REQUIRE(searches.size() == 1);
    const auto& [problem, of_a, of_b] = searches.front();  // models in order: 3, 5
    CHECK(of_a != &parts[0].delivery().objects);
    CHECK(of_a != &parts[1].delivery().objects);
    CHECK(of_a->size() == 3);
    CHECK(of_b == &parts[0].delivery().objects);
    using Ids = std::multiset<std::pair<std::uint64_t, std::uint32_t>>;
    CHECK(ids_of(*of_a, problem.a) == Ids{{1, 1}, {2, 0}, {2, 1}});
    CHECK(ids_of(*of_b, problem.b) == Ids{{1, 0}, {1, 2}});
  }
}

TEST_CASE("few models are searched pair by pair, more are one set",
          "[collide][parallel][voxel_problem]") {
  std::vector<std::uint32_t> models;
  for (std::uint32_t m = 0; m < most_separate_models; ++m) models.push_back(100 + m);
  VoxelProblem voxel;
  for (int time = 0; time < 2; ++time) {  // the memory is used again
    const std::vector<Part> few{part_of(1, models), part_of(2, models)};
    CHECK(searches_of(voxel, few, WithinModel::skip).size() ==
          most_separate_models * (most_separate_models - 1) / 2);
    CHECK(voxel.models().empty());

    const std::vector<Part> many{part_of(1, models), part_of(2, {7, 103})};
    const auto searches = searches_of(voxel, many, WithinModel::skip);
    REQUIRE(searches.size() == 1);
    const auto& [problem, of_a, of_b] = searches.front();
    CHECK(problem.within_a);
    CHECK(problem.a.size() == models.size() + 2);
    CHECK(of_a == of_b);
    for (const search::Entry entry : problem.a) {
      const std::uint32_t object = search::object_of(entry);
      CHECK(ModelId{voxel.models()[object]} == of_a->model(object));
    }
  }
}

TEST_CASE("natives of one model are not compared with each other",
          "[collide][parallel][voxel_problem]") {
  const Part all = part_of(1, {5, 5, 5, 0, 1, 2, 3, 4, 6, 7, 8, 9});
  auto delivery = std::make_shared<Delivery>();
  delivery->objects.append(all.delivery().objects, all.entries(), delivery->sorted);
  VoxelProblem voxel;
  const auto searches = searches_of(voxel, {Part(delivery, 0, 3, 9)}, WithinModel::skip);
  REQUIRE(searches.size() == 1);
  CHECK_FALSE(searches.front().problem.within_a);
  CHECK(searches.front().problem.b.size() == 9);
  CHECK(voxel.models().size() == 12);
}

TEST_CASE("if pairs within a model count, all objects are one set",
          "[collide][parallel][voxel_problem]") {
  const std::vector<Part> parts{part_of(1, {5, 3}), part_of(2, {3})};
  VoxelProblem voxel;
  const auto searches = searches_of(voxel, parts, WithinModel::test);
  REQUIRE(searches.size() == 1);
  CHECK(searches.front().problem.within_a);
  using Ids = std::multiset<std::pair<std::uint64_t, std::uint32_t>>;
  CHECK(ids_of(*searches.front().of_a, searches.front().problem.a) == Ids{{1, 0}, {1, 1}, {2, 0}});
}

}  // namespace tess::collide
