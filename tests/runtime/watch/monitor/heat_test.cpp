// The layout of heat maps, and what process 0 makes of the cells that PEs report.
#include "runtime/watch/monitor/heat_grid.hpp"
#include "runtime/watch/monitor/heat_map.hpp"
#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>
#include <vector>

using nlohmann::json;
using tess::CollectionId;
using tess::PeId;
using tess::Range;
using tess::detail::HeatBy;
using tess::detail::HeatGrid;
using tess::detail::HeatMap;

namespace {

void check(const Range& range) {
  INFO(range.extent[0] << " x " << range.extent[1] << " x " << range.extent[2] << ", "
                       << range.n_axes << " axes");
  const HeatGrid grid(range);
  CHECK(grid.n_cells() > 0);
  CHECK(grid.n_cells() <= HeatGrid::most_cells);
  if (range.n_axes == 2 || range.n_axes == 3)
    for (const std::int64_t n : grid.shape()) CHECK(n <= HeatGrid::most_on_axis);
  // Each index has a cell, and each cell has as many as it says.
  std::vector<std::uint64_t> n(grid.n_cells());
  for (std::uint64_t rank = 0; rank < range.size(); ++rank)
    ++n.at(grid.cell_of(static_cast<std::int64_t>(rank)));
  bool equal = true;
  for (std::uint32_t cell = 0; cell < grid.n_cells(); ++cell)
    equal = equal && n[cell] == grid.n_indices(cell);
  CHECK(equal);
}

std::string cell_text(const Range& range, std::int64_t rank) {
  const HeatGrid grid(range);
  return grid.text_of(grid.cell_of(rank));
}

json event(HeatMap& map) {
  const auto text = map.take_event("Block");
  return text ? json::parse(*text) : json();
}

}  // namespace

TEST_CASE("a heat map of any dense array is bounded, and each index has one cell",
          "[runtime][monitor]") {
  for (const int n : {1, 2, 7, 8, 9, 100, 127, 16384, 16385, 1'000'000}) check(tess::range(n));
  check(tess::range(1, 1));
  check(tess::range(16, 16));
  check(tess::range(3, 200));
  check(tess::range(1000, 1000));
  check(tess::range(1, 1'000'000));
  check(tess::range(1, 1, 1));
  check(tess::range(4, 5, 6));
  check(tess::range(100, 100, 100));
  check(tess::range(2, 2, 250'000));
  check(tess::range(129, 1, 1));
  check(tess::range(7, 6, 5, 4));
  check(tess::range(10, 10, 10, 10, 10, 10));
}

TEST_CASE("a cell of a heat map names its indices", "[runtime][monitor]") {
  CHECK(cell_text(tess::range(10), 3) == "[3]");
  CHECK(cell_text(tess::range(1'000'000), 62) == "[62…123]");
  CHECK(cell_text(tess::range(16, 16), 16 * 5 + 2) == "[5,2]");
  CHECK(cell_text(tess::range(1000, 1000), 1000 * 9 + 17) == "[8…15,16…23]");
  CHECK(cell_text(tess::range(1000, 1001), 1001 * 999 + 1000) == "[992…999,1000]");
  CHECK(cell_text(tess::range(4, 5, 6), (3 * 5 + 4) * 6 + 2) == "[3,4,2]");
  CHECK(cell_text(tess::range(7, 6, 5, 4), 100) == "rank 100");
  CHECK(cell_text(tess::sparse, 5000) == "hash 904 of 1024");
}

TEST_CASE("a row of a two-dimensional heat map is a row of y", "[runtime][monitor]") {
  const HeatGrid grid(tess::range(3, 2));  // rank = 2 x + y
  CHECK(grid.shape() == HeatGrid::Axes{3, 2, 1});
  CHECK(grid.cell_of(1) == 3);  // x 0, y 1
  CHECK(grid.cell_of(4) == 2);  // x 2, y 0
}

TEST_CASE("the load of a cell is the mean of lately reported parts of a PE, for each element",
          "[runtime][monitor]") {
  HeatMap map(HeatBy::load, 2);
  const Range range = tess::range(4);
  CHECK(event(map).is_null());
  for (int i = 0; i < 3; ++i) {
    map.take({{}, PeId{0}, range, {0, 1}, {0.5F, 0.3F}});
    map.take({{}, PeId{1}, range, {3}, {0.125F}});
    const json shown = event(map);
    CHECK(shown["shape"] == json({4, 1, 1}));
    CHECK(shown["values"] == "ff990040");
    CHECK(shown["most"].get<double>() == Approx(0.5).epsilon(0.35));  // one period had no report
  }
  CHECK(map.last_event().find("hottest [0]: ") != std::string::npos);
  CHECK(map.last_event().find("1 without load") != std::string::npos);
  // A PE that ran a long entry method reports for all periods since.
  for (int i = 0; i < 3; ++i) {
    map.take({{}, PeId{0}, range, {0, 1}, {0.5F, 0.3F}});
    (void)event(map);
  }
  map.take({{}, PeId{0}, range, {0, 1}, {0.5F, 0.3F}});
  map.take({{}, PeId{1}, range, {3}, {0.125F}});
  const std::string values = event(map)["values"];
  CHECK(std::stoi(values.substr(6, 2), nullptr, 16) >= 0x40);
  CHECK(std::stoi(values.substr(6, 2), nullptr, 16) <= 0x50);
  // What is idle fades.
  for (int i = 0; i < 200; ++i) {
    map.take({{}, PeId{1}, range, {3}, {0.125F}});
    (void)event(map);
  }
  CHECK(json::parse(map.last_event())["values"] == "000000ff");
}

TEST_CASE("cells of fewer elements compare by the load of one", "[runtime][monitor]") {
  const Range range = tess::range(2, 201);  // two elements in a cell, and one in those at the end
  const HeatGrid grid(range);
  const std::uint32_t whole = grid.cell_of(0), end = grid.cell_of(200);
  REQUIRE(grid.n_indices(whole) == 2);
  REQUIRE(grid.n_indices(end) == 1);
  HeatMap map(HeatBy::load, 1);
  map.take({{}, PeId{0}, range, {whole, end}, {0.4F, 0.4F}});
  const std::string values = event(map)["values"];
  CHECK(values.substr(2 * end, 2) == "ff");
  CHECK(values.substr(2 * whole, 2) == "80");  // a half
}

TEST_CASE("a report that comes very late counts for twenty periods", "[runtime][monitor]") {
  const auto level_after = [](int n_silent) {
    HeatMap map(HeatBy::load, 2);
    const Range range = tess::range(2);
    for (int i = 0; i <= n_silent; ++i) {
      map.take({{}, PeId{0}, range, {0}, {0.5F}});
      if (i == n_silent) map.take({{}, PeId{1}, range, {1}, {0.1F}});
      if (i < n_silent) (void)event(map);
    }
    return std::stoi(event(map)["values"].get<std::string>().substr(2, 2), nullptr, 16);
  };
  // PE 0 has 0.5 (1 + 0.93 + 0.93² + …) = 7.1, and PE 1 at most 20 times 0.1.
  CHECK(level_after(0) == 51);
  CHECK(level_after(200) == Approx(255 * 2.0 / (0.5 / 0.07)).margin(1));
  CHECK(level_after(1000) == level_after(200));
}

TEST_CASE("a cell shows the PE that holds most of its elements", "[runtime][monitor]") {
  HeatMap map(HeatBy::pe, 3);
  const Range range = tess::range(4, 4);  // 4 x 4 cells
  map.take({{}, PeId{0}, range, {0, 1}, {1, 1}});
  map.take({{}, PeId{2}, range, {1, 2}, {2, 1}});
  json shown = event(map);
  CHECK(shown["pes"] == 3);
  CHECK(shown["values"] == json({0, 2, 2, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}));
  CHECK(shown["summary"] == "5 elements on 2 of 3 PEs, at most 3 on PE 2");
  CHECK(event(map).is_null());  // unchanged
  map.take({{}, PeId{2}, range, {}, {}});
  shown = event(map);
  CHECK(shown["values"][1] == 0);
  CHECK(shown["values"][2] == -1);
}
