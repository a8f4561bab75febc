#include "runtime/pe/tables/future_table.hpp"

#include "tests/support/catch.hpp"

#include <array>

using tess::detail::FutureTable;

TEST_CASE("a number that is no longer in use finds no future, though its place is used again",
          "[runtime][future]") {
  FutureTable table;
  int first = 0, second = 0;
  const std::uint64_t id = table.enter(&first);
  CHECK(id != 0);
  CHECK(table.find(id) == &first);
  table.leave(id);
  CHECK(table.find(id) == nullptr);
  const std::uint64_t later = table.enter(&second);
  CHECK(static_cast<std::uint32_t>(later) == static_cast<std::uint32_t>(id));  // the same place
  CHECK(table.find(id) == nullptr);
  table.leave(id);  // has left before
  CHECK(table.find(later) == &second);
}

TEST_CASE("a future that moves is found where it is", "[runtime][future]") {
  FutureTable table;
  int from = 0, to = 0;
  const std::uint64_t id = table.enter(&from);
  table.move(id, &to);
  CHECK(table.find(id) == &to);
  table.move(id + 1, &from);  // never made
  CHECK(table.find(id + 1) == nullptr);
}

TEST_CASE("after a restart no new future has a number of the saved run, and earlier ones are found",
          "[runtime][future]") {
  FutureTable table;
  int before = 0, moved = 0, after = 0;
  const std::uint64_t early = table.enter(&before);
  table.begin_behind(100);
  CHECK(table.n_places() >= 100);
  const std::uint64_t id = table.enter(&after);
  CHECK(static_cast<std::uint32_t>(id) >= 100);
  CHECK(table.find(early) == &before);
  table.move(early, &moved);
  CHECK(table.find(early) == &moved);
  table.leave(early);
  CHECK(table.find(early) == nullptr);
  CHECK(table.find(id) == &after);
}

TEST_CASE("a run that made more futures than the saved one keeps them apart from new ones",
          "[runtime][future]") {
  FutureTable table;
  std::array<int, 3> before{};
  std::array<std::uint64_t, 3> early{};
  for (std::size_t i = 0; i < 3; ++i) early[i] = table.enter(&before[i]);
  table.begin_behind(1);
  int after = 0;
  const std::uint64_t id = table.enter(&after);
  for (std::size_t i = 0; i < 3; ++i) CHECK(table.find(early[i]) == &before[i]);
  CHECK(table.find(id) == &after);
}
