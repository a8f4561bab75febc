// The table of a PE's indices, against a std::map.
#include "runtime/arrays/location/index_table.hpp"

#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <map>

namespace {

using namespace tess;
using namespace tess::detail;

struct Anything {};
using Table = IndexTable<Index2, Anything>;
using Truth = std::map<std::pair<int, int>, std::uint32_t>;  // the incarnation of each hint

Truth contents(const Table& table) {
  Truth all;
  table.for_each([&all](const Index2& index, const Table::Record& record) {
    if (!record.empty()) all[{index.x, index.y}] = record.version().incarnation;
  });
  return all;
}

void play(const Range& range, std::uint64_t seed) {
  INFO("seed " << seed);
  Random random(seed);
  Table table(range);
  Truth truth;
  const int width = 1 + static_cast<int>(random.below(60));
  for (int step = 1; step <= 2000; ++step) {
    const Index2 index{static_cast<int>(random.below(static_cast<std::uint64_t>(width))) - 5,
                       static_cast<int>(random.below(20))};
    const std::pair key(index.x, index.y);
    if (random.chance(0.6)) {
      const auto life = static_cast<std::uint32_t>(step);
      table.at(index).set(IndexState::hint, PeId{3}, Version{life, 1});
      truth[key] = life;
    } else {
      if (auto* record = table.find(index); record != nullptr) record->set_unknown();
      table.tidy(index);
      truth.erase(key);
    }
    if (step % 500 == 0) REQUIRE(contents(table) == truth);
    auto* const found = table.find(index);
    REQUIRE((found != nullptr && !found->empty()) == truth.contains(key));
  }
  table.forget_hints();
  REQUIRE(contents(table).empty());
}

}  // namespace

TEST_CASE("the index table holds what was entered, inside and outside the array's range",
          "[runtime][location]") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    play(Range{}, seed);
    play(range(40, 17), seed);
  }
}

TEST_CASE("to forget hints keeps all else", "[runtime][location]") {
  Table table(Range{});
  for (int i = 0; i < 3000; ++i) {
    const auto state = i % 3 == 0   ? IndexState::hint
                       : i % 3 == 1 ? IndexState::live
                                    : IndexState::departed;
    table.at(Index2{i, -i}).set(state, PeId{1}, Version{1, 1});
  }
  table.at(Index2{0, 0}).park(Parked::waiting);
  table.forget_hints();
  CHECK(contents(table).size() == 2001);
  CHECK(table.find(Index2{0, 0})->parks(Parked::waiting));
  CHECK(table.find(Index2{3, -3}) == nullptr);
  CHECK(table.find(Index2{4, -4})->state() == IndexState::live);
}
