// The rules by which leaves choose their levels, without chares.
#include "apps/amr/neighbourhood.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>

using namespace amr;

namespace {

constexpr Face upper_x = 1;

/// All leaves of a tree that tell each other their choices, in an order drawn by a seed.
class Tree {
 public:
  void add(BlockIndex index, const Sides& sides) {
    leaves_.emplace(index, Neighbourhood(index)).first->second.set_sides(sides);
  }
  /// The levels that the leaves end at; `steepness` gives that of each.
  template <class Steepness>
  std::map<BlockIndex, std::int32_t> choose(const Steepness& steepness, const Problem& problem,
                                            std::size_t seed) {
    for (auto& [index, leaf] : leaves_) leaf.choose(steepness(index), problem);
    for (const auto& [index, leaf] : leaves_) tell(leaf);
    while (!messages_.empty()) {
      seed = seed * 6364136223846793005U + 1442695040888963407U;
      const std::size_t next = (seed >> 33U) % messages_.size();
      const auto [to, choice] = messages_[next];
      messages_.erase(messages_.begin() + static_cast<std::ptrdiff_t>(next));
      if (leaves_.at(to).hear(choice)) tell(leaves_.at(to));
    }
    std::map<BlockIndex, std::int32_t> levels;
    for (const auto& [index, leaf] : leaves_) levels[index] = leaf.choice();
    return levels;
  }
  [[nodiscard]] const Neighbourhood& operator[](BlockIndex index) const {
    return leaves_.at(index);
  }

 private:
  void tell(const Neighbourhood& leaf) {
    for (Face face = 0; face < n_faces; ++face)
      for (const auto& [to, quadrant] : leaf.behind(face))
        messages_.push_back({to, Choice{face ^ 1, quadrant, leaf.choice()}});
  }
  std::map<BlockIndex, Neighbourhood> leaves_;
  std::vector<std::pair<BlockIndex, Choice>> messages_;
};

Tree uniform(std::int32_t level) {
  Tree tree;
  for (std::int32_t i = 0; i < 1 << 3 * level; ++i) {
    const std::int32_t n = 1 << level;
    tree.add(BlockIndex::at(level, {i % n, i / n % n, i / n / n}), Sides{});
  }
  return tree;
}

Problem levels(std::int32_t least, std::int32_t most) {
  Problem problem;
  problem.least_level = least;
  problem.most_level = most;
  problem.refine = 1;
  return problem;
}

}  // namespace

TEST_CASE("behind a face are one leaf, or four finer ones that have this leaf behind theirs",
          "[apps][amr]") {
  const BlockIndex own = BlockIndex::at(2, {1, 2, 3});
  Neighbourhood leaf(own);
  for (Face face = 0; face < n_faces; ++face) {
    Sides sides{};
    leaf.set_sides(sides);
    REQUIRE(leaf.behind(face).size() == 1);
    CHECK(leaf.behind(face)[0].index == own.neighbour(face));
    sides[static_cast<std::size_t>(face)] = 1;
    leaf.set_sides(sides);
    const std::vector<Neighbour> finer = leaf.behind(face);
    REQUIRE(finer.size() == n_quadrants);
    for (std::int32_t quadrant = 0; quadrant < n_quadrants; ++quadrant) {
      const BlockIndex other = finer[static_cast<std::size_t>(quadrant)].index;
      CHECK(other.parent() == own.neighbour(face));
      Neighbourhood back(other);
      Sides coarser{};
      coarser[static_cast<std::size_t>(face ^ 1)] = -1;
      back.set_sides(coarser);
      REQUIRE(back.behind(face ^ 1).size() == 1);
      CHECK(back.behind(face ^ 1)[0].index == own);
      CHECK(back.behind(face ^ 1)[0].quadrant == quadrant);
    }
  }
}

TEST_CASE("choices end at the same levels in any order, no two above a neighbour's",
          "[apps][amr]") {
  const Problem problem = levels(0, 3);
  const BlockIndex steep = BlockIndex::at(2, {1, 1, 1});
  // All others would merge; those beside the steep leaf, and their siblings, may not.
  const auto steepness = [&](BlockIndex index) { return index == steep ? 2.0 : 0.0; };
  Tree tree = uniform(2);
  const auto want = tree.choose(steepness, problem, 1);
  CHECK(want.at(steep) == 3);
  CHECK(want.at(steep.neighbour(upper_x)) == 2);
  CHECK(std::ranges::count(want, 1, [](const auto& one) { return one.second; }) > 0);
  for (const auto& [index, level] : want) {
    for (Face face = 0; face < n_faces; ++face)
      CHECK(std::abs(level - want.at(index.neighbour(face))) <= 1);
    if (level == 1)
      for (std::int32_t octant = 0; octant < n_octants; ++octant)
        CHECK(want.at(index.parent().child(octant)) == 1);
  }
  for (std::size_t seed = 2; seed < 20; ++seed) {
    Tree again = uniform(2);
    CHECK(again.choose(steepness, problem, seed) == want);
  }
}

TEST_CASE("a leaf merges beside finer leaves that merge, but not before its siblings are leaves",
          "[apps][amr]") {
  // Level 1, of which one leaf has its eight children.
  const BlockIndex parent = BlockIndex::at(1, {1, 0, 1});
  Tree tree;
  for (std::int32_t octant = 0; octant < n_octants; ++octant) {
    const BlockIndex coarse = BlockIndex{}.child(octant), fine = parent.child(octant);
    Sides outward{}, inward{};
    for (Face face = 0; face < n_faces; ++face) {
      if (coarse.neighbour(face) == parent) outward[static_cast<std::size_t>(face)] = 1;
      if (is_outer(octant, face)) inward[static_cast<std::size_t>(face)] = -1;
    }
    if (coarse != parent) tree.add(coarse, outward);
    tree.add(fine, inward);
  }
  const auto got = tree.choose([](BlockIndex) { return 0.0; }, levels(0, 3), 1);
  // Its children merge; the others wait until it is a leaf.
  for (const auto& [index, level] : got) CHECK(level == 1);

  // One level further down: all but its siblings merge at the same time as its children.
  const BlockIndex deep = BlockIndex::at(2, {1, 1, 1});
  Tree larger;
  for (std::int32_t i = 0; i < 64; ++i) {
    const BlockIndex leaf = BlockIndex::at(2, {i % 4, i / 4 % 4, i / 16});
    if (leaf == deep) continue;
    Sides sides{};
    for (Face face = 0; face < n_faces; ++face)
      if (leaf.neighbour(face) == deep) sides[static_cast<std::size_t>(face)] = 1;
    larger.add(leaf, sides);
  }
  for (std::int32_t octant = 0; octant < n_octants; ++octant) {
    Sides sides{};
    for (Face face = 0; face < n_faces; ++face)
      if (is_outer(octant, face)) sides[static_cast<std::size_t>(face)] = -1;
    larger.add(deep.child(octant), sides);
  }
  for (const auto& [index, level] :
       larger.choose([](BlockIndex) { return 0.0; }, levels(0, 4), 3)) {
    const bool is_sibling = index.level() == 2 && index.parent() == deep.parent();
    CHECK(level == (index.level() == 3 || is_sibling ? 2 : 1));
  }
}

TEST_CASE("parts know what will be behind their outer faces", "[apps][amr]") {
  Tree tree = uniform(1);
  const BlockIndex steep = BlockIndex::at(1, {0, 0, 0});
  const auto steepness = [&](BlockIndex index) { return index == steep ? 2.0 : 0.5; };
  (void)tree.choose(steepness, levels(0, 2), 1);
  for (std::int32_t octant = 0; octant < n_octants; ++octant)
    for (Face face = 0; face < n_faces; ++face)
      CHECK(tree[steep].next_sides(octant)[static_cast<std::size_t>(face)] ==
            (is_outer(octant, face) ? -1 : 0));
  const Neighbourhood& beside = tree[steep.neighbour(upper_x)];
  CHECK(beside.next_sides()[upper_x ^ 1] == 1);
  CHECK(beside.next_sides()[2] == 0);
}
