#include "runtime/core/hilbert.hpp"

#include "tests/support/catch.hpp"

#include <vector>

using namespace tess;

TEST_CASE("a Hilbert curve visits each cell once and steps to a neighbour", "[runtime]") {
  for (const std::size_t n_axes : {1U, 2U, 3U}) {
    const unsigned bits = 3;
    const std::size_t n_cells = std::size_t{1} << (bits * n_axes);
    std::vector<std::array<std::uint32_t, 3>> at(n_cells);
    std::vector<bool> seen(n_cells, false);
    for (std::uint32_t c = 0; c < n_cells; ++c) {
      const std::array<std::uint32_t, 3> cell{c & 7U, c >> 3U & 7U, c >> 6U};
      const std::uint64_t key = hilbert_key(cell, n_axes, bits);
      REQUIRE(key < n_cells);
      REQUIRE_FALSE(seen[key]);
      seen[key] = true;
      at[key] = cell;
    }
    for (std::size_t k = 1; k < n_cells; ++k) {
      std::uint32_t steps = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        steps += at[k][axis] > at[k - 1][axis] ? at[k][axis] - at[k - 1][axis]
                                               : at[k - 1][axis] - at[k][axis];
      REQUIRE(steps == 1);
    }
  }
}

TEST_CASE("a position on a Hilbert curve begins with that of the cell around it", "[runtime]") {
  for (std::uint64_t cell = 0; cell < 4096; ++cell)
    REQUIRE(hilbert_position(cell, 4) >> 3U == hilbert_position(cell >> 3U, 3));
  for (std::uint32_t c = 0; c < 4096; ++c)
    for (const std::size_t n_axes : {1U, 2U, 3U}) {
      const std::array<std::uint32_t, 3> cell{c & 15U, c >> 4U & 15U, c >> 8U};
      const std::array<std::uint32_t, 3> around{cell[0] / 2, cell[1] / 2, cell[2] / 2};
      REQUIRE(hilbert_key(cell, n_axes, 4) >> n_axes == hilbert_key(around, n_axes, 3));
    }
}
