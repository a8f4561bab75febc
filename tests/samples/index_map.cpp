// The sample of runtime/more/index_map.hpp, compiled and run. tests/samples/check.py compares the text.
#include "runtime/more/index_map.hpp"

#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

namespace {

class GridCell : public tess::Chare<GridCell, tess::Index2> {
 public:
  [[nodiscard]] tess::PeId where() { return tess::my_pe(); }
};

/// All cells of a column are on one PE.
struct ByColumn {
  std::int32_t n_columns;
  tess::PeId operator()(const tess::Index2& cell, std::int32_t n_pes) const {
    return tess::PeId{cell.y * n_pes / n_columns};
  }
};

tess::Task place(std::vector<int>& found) {
  const auto cells = tess::create<GridCell>(tess::mapped(tess::range(4, 8), ByColumn{8}));
  for (int y = 0; y < 8; ++y) {
    const tess::PeId at = co_await cells[{y % 4, y}].ask<&GridCell::where>();
    found.push_back(at.value);
  }
}

}  // namespace

TEST_CASE("the sample of maps places columns", "[runtime][sample][map]") {
  std::vector<int> found;
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return place(found); }) == 0);
  CHECK(found == std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1});
}
