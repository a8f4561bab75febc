// Levels of sizes, as both searches divide a problem.
#include "collide/problem/size_levels.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <random>

using namespace tess::collide;

TEST_CASE("the level of a size is the first whose greatest size is not below it",
          "[collide][levels]") {
  const double inf = std::numeric_limits<double>::infinity();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-990, 1023), uniform(1, 2);
  for (int i = 0; i < 2000; ++i) {
    const double greatest = std::ldexp(uniform(random), static_cast<int>(exponent(random)));
    const search::SizeLevels levels(greatest);
    Level level = 0;
    for (double most = greatest;; most *= 8, ++level) {
      REQUIRE(levels.of(most) == level);
      REQUIRE(levels.of(std::nextafter(most, 0.0)) == level);
      if (std::isinf(most)) break;
      REQUIRE(levels.of(std::nextafter(most, inf)) == level + 1);
      if (most < 1e150) REQUIRE(levels.of(most * uniform(random) * uniform(random)) == level + 1);
    }
    REQUIRE(levels.n() == level + 1);
    for (const double small : {0.0, 5e-324, greatest / 2, greatest / 1e6})
      REQUIRE(levels.of(small) == 0);
  }
}

TEST_CASE("entries stand by their levels, each in the order of the input", "[collide][levels]") {
  const auto cube = [](double size) { return Aabb{{0, 0, 0}, {size, size / 2, 0}}; };
  const std::vector<Aabb> boxes{cube(9), cube(1), cube(0), cube(64), cube(8), cube(65), cube(2)};
  std::vector<search::Entry> all;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) all.push_back(search::make_entry(i, 5));
  const search::ByLevel by_level(boxes.data(), all, search::SizeLevels(1));
  const auto objects = [](std::span<const search::Entry> entries) {
    std::vector<std::uint32_t> out;
    for (const search::Entry entry : entries) out.push_back(search::object_of(entry));
    return out;
  };
  using Numbers = std::vector<std::uint32_t>;
  CHECK(objects(by_level.of(0)) == Numbers{1, 2});
  CHECK(objects(by_level.of(1)) == Numbers{4, 6});
  CHECK(objects(by_level.of(2)) == Numbers{0, 3});
  CHECK(objects(by_level.of(3)) == Numbers{5});
  CHECK(by_level.of(4).empty());
  CHECK(by_level.below(0).empty());
  CHECK(objects(by_level.below(2)) == Numbers{1, 2, 4, 6});
}
