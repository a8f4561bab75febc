// The grid of the parallel collision: coordinates to cells, and the errors of bad ones.
#include "collide/problem/voxel_grid.hpp"

#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace tess::collide;

TEST_CASE("the conversions of all widths agree bit for bit, also on invalid boxes", "[collide]") {
  namespace conversion = search::conversion;
  const std::vector forms {
    &conversion::convert,
#ifdef __AVX2__
        &conversion::convert_avx2,
#endif
#if defined(__AVX512VL__) && defined(__AVX512DQ__)
        &conversion::convert_avx512,
#endif
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const VoxelGrid grid({0.1, -1e9, 0}, {0.3, 1e-7, 1});
  std::vector<double> values{0, -0.0, 1, -1, 0.1, -5e-324, 5e-324, nan, inf, -inf, 1e300, -1e300};
  values.insert(values.end(),
                {2147483647, 2147483647.9999998, 2147483648, -2147483648, -2147483649});
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> uniform(-100, 100);
  for (int i = 0; i < 200; ++i) values.push_back(0.3 * std::round(uniform(random)) + 0.1);
  for (int i = 0; i < 200; ++i) values.push_back(uniform(random));
  std::array<double, 6> box{};
  std::size_t n_good = 0, n_inside_out = 0, n_nan = 0;
  for (int i = 0; i < 40'000; ++i) {
    for (double& x : box) x = values[random() % values.size()];
    if (i % 4 < 2)  // only here are there indices on the second axis
      for (const std::size_t k : {1u, 4u}) box[k] = -1e9 + 1e-7 * uniform(random);
    if (i % 2 == 0)
      for (std::size_t k = 0; k < 3; ++k)
        if (box[k] > box[k + 3]) std::swap(box[k], box[k + 3]);
    if (i % 16 < 2) box[random() % 6] = nan;
    const auto has_index = [&](std::size_t k) {
      const double cell =
          std::floor((box[k] - grid.constants().origin[k]) * grid.constants().per_voxel[k]);
      return cell >= -2147483648.0 && cell <= 2147483647.0;
    };
    std::size_t n_indices = 0, n_nans = 0, n_ordered = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      n_indices += has_index(k) ? 1u : 0u;
      n_nans += std::isnan(box[k]) ? 1u : 0u;
      n_ordered += k < 3 && box[k] <= box[k + 3] ? 1u : 0u;
    }
    const bool valid = n_indices == 6 && n_ordered == 3;
    n_good += valid ? 1u : 0u;
    n_inside_out += n_indices == 6 && n_ordered < 3 ? 1u : 0u;
    n_nan += n_nans == 1 && n_indices == 5 ? 1u : 0u;

    CAPTURE(box);
    std::array<std::int32_t, 6> plain{};
    REQUIRE(conversion::convert_plain(grid.constants(), box.data(), plain.data()) == valid);
    for (const auto convert : forms) {
      std::array<std::int32_t, 6> cells{};
      REQUIRE(convert(grid.constants(), box.data(), cells.data()) == valid);
      REQUIRE(cells == plain);
    }
    if (valid) {
      const tess::collide::CellRange cells =
          grid.cells_of({{box[0], box[1], box[2]}, {box[3], box[4], box[5]}});
      REQUIRE(cells == tess::collide::CellRange{{plain[0], plain[1], plain[2]},
                                                {plain[3], plain[4], plain[5]}});
    }
  }
  REQUIRE(n_good > 1000);
  REQUIRE(n_inside_out > 1000);  // nothing else is wrong with these
  REQUIRE(n_nan > 500);
}

TEST_CASE("errors name bad coordinates and voxel sizes", "[collide]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  REQUIRE_THROWS_WITH(VoxelGrid(1).cell_of({1, -3e9, 0}), Contains("-3e+09"));
  REQUIRE_THROWS_AS(VoxelGrid(1).cell_of({nan, 0, 0}), tess::Error);
  REQUIRE(VoxelGrid(1).cell_of({2147483647.5, -2147483648.0, -5e-324}) ==
          Cell{2147483647, -2147483647 - 1, -1});
  REQUIRE_THROWS_AS(VoxelGrid(0), tess::Error);
  REQUIRE_THROWS_WITH(VoxelGrid({0, 0, 0}, {1, 0, 1}),
                      Contains("size 0 on axis 1") && Contains("or 0 for all"));
  REQUIRE_THROWS_AS(VoxelGrid(nan), tess::Error);
  REQUIRE_THROWS_AS(VoxelGrid(1e-310), tess::Error);
}
