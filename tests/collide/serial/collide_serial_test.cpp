// Compares the serial collision with overlap() of all pairs.
#include "collide/collide_serial.hpp"

#include "collide/voxel_size.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace tess;
using namespace tess::collide;

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Item item(const Aabb& box, std::size_t n, std::uint32_t model) {
  return {box, {OwnerId{7}, LocalId{static_cast<std::uint32_t>(n)}, ModelId{model}}};
}

void add(Pairs& pairs, const Item& a, const Item& b) {
  pairs.push_back(
      std::minmax(static_cast<std::uint32_t>(a.id.local), static_cast<std::uint32_t>(b.id.local)));
}

Pairs oracle(std::span<const Item> items, PairRules rules) {
  Pairs out;
  for (std::size_t i = 0; i < items.size(); ++i)
    for (std::size_t j = i + 1; j < items.size(); ++j)
      if ((rules.within_model == WithinModel::test || items[i].id.model != items[j].id.model) &&
          overlap(items[i].box, items[j].box, rules.touching))
        add(out, items[i], items[j]);
  std::sort(out.begin(), out.end());
  return out;
}

Pairs found(std::span<const Item> items, const VoxelGrid& grid, PairRules rules,
            SerialMethod method = SerialMethod::automatic) {
  Pairs out;
  collide_serial(
      items, grid, rules, [&](const Item& a, const Item& b) { add(out, a, b); }, method);
  std::sort(out.begin(), out.end());
  return out;
}

/// Compares every method, rule, origin and size. A pair that is reported twice makes the lists
/// differ.
void check_scene(std::span<const Item> items, std::initializer_list<double> sizes, double shift) {
  for (const auto touching : {Touching::counts, Touching::does_not_count})
    for (const auto within : {WithinModel::skip, WithinModel::test}) {
      const PairRules rules{touching, within};
      const Pairs expected = oracle(items, rules);
      for (const double size : sizes)
        for (const double origin : {0.0, shift, -3.7 * shift})
          for (const auto method : {SerialMethod::automatic, SerialMethod::brute_force,
                                    SerialMethod::sweep, SerialMethod::bisection}) {
            const VoxelGrid grid({origin, -origin, origin}, {size, size, size});
            CAPTURE(size, origin, static_cast<int>(method), static_cast<int>(touching));
            REQUIRE((found(items, grid, rules, method) == expected));
          }
    }
}

std::vector<Item> random_scene(unsigned seed, std::size_t n, double offset, double scale,
                               bool on_lattice) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-5, 5), logarithm(-3, 0.5);
  std::vector<Item> items;
  for (std::size_t i = 0; i < n; ++i) {
    Aabb box{};
    const double extent = i % 5 == 0 ? 0 : std::pow(10, logarithm(random));
    for (std::size_t k = 0; k < 3; ++k) {
      double x = uniform(random), w = extent;
      if (on_lattice) x = std::round(x), w = std::round(w);
      box.lo[k] = offset + scale * x;
      box.hi[k] = std::max(box.lo[k], offset + scale * (x + w));
    }
    items.push_back(item(box, i, static_cast<std::uint32_t>(i % 3)));
  }
  return items;
}

}  // namespace

TEST_CASE("each pair of random boxes is found once for every voxel size and origin", "[collide]") {
  check_scene(random_scene(1, 300, 0, 1, false), {0.2, 0.7, 1, 20, 1e9}, 0.3);
}

TEST_CASE("each pair of boxes and points on voxel faces is found once", "[collide]") {
  check_scene(random_scene(2, 300, 0, 1, true), {0.5, 1, 2, 3}, 0.5);
}

TEST_CASE("no pair is lost at offsets and scales from 1e-310 to 1e30", "[collide]") {
  check_scene(random_scene(3, 200, 1e9, 1, false), {0.5, 1.7}, 0.9);
  check_scene(random_scene(4, 200, 0, 1e30, false), {1e30, 3e29}, 1e29);
  check_scene(random_scene(5, 200, 0, 1e-9, false), {1e-9, 1}, 1e-9);
  check_scene(random_scene(6, 200, 0, 1e-310, false), {1e-300, 1}, 1e-310);
}

TEST_CASE("all 93 556 pairs of a lattice are found, some of which other libraries lose",
          "[collide]") {
  std::vector<Item> items;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (int z = 0; z < 20; ++z) {
        const Point lo{0.1 * x, 0.1 * y, 0.1 * z};
        items.push_back(item({lo, {lo[0] + 0.15, lo[1] + 0.15, lo[2] + 0.15}}, items.size(), 0));
      }
  for (const double size : {0.3, 0.1, 0.05, 0.77, 5.0})
    for (const auto method : {SerialMethod::automatic, SerialMethod::bisection})
      CHECK(found(items, VoxelGrid(size), {Touching::counts, WithinModel::test}, method).size() ==
            93'556);
}

TEST_CASE("the vector form and the plain form of a probe agree", "[collide]") {
  const auto items = random_scene(8, 64, 0, 1, true);
  serial::Lanes lanes;
  lanes.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i)
    lanes.set(i, items[i],
              serial::axes_below({static_cast<int>(i % 2), static_cast<int>(i % 3), 0}, {0, 0, 0}),
              static_cast<std::uint32_t>(i));
  for (std::size_t i = 0; i < items.size(); ++i) {
    const serial::Probe<Touching::counts, WithinModel::skip> closed(lanes, i);
    const serial::Probe<Touching::does_not_count, WithinModel::test> open(lanes, i);
    for (std::size_t j = 0; j < items.size(); ++j) {
      REQUIRE(closed.overlaps(lanes, j) == closed.overlaps_plain(lanes, j));
      REQUIRE(open.overlaps(lanes, j) == open.overlaps_plain(lanes, j));
    }
  }
}

TEST_CASE("bisection ends if all boxes of a node touch the plane", "[collide]") {
  std::vector<Item> items;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 3; ++y) {
      const double at = x < 4 ? 0 : 1;
      items.push_back(item({{at, at, at}, {at + 1, at + 1, at + 1}}, items.size(), 0));
    }
  const PairRules rules{Touching::counts, WithinModel::test};
  REQUIRE((found(items, VoxelGrid(10), rules, SerialMethod::bisection) == oracle(items, rules)));
}

TEST_CASE("the conversions of all widths agree bit for bit, also on invalid boxes", "[collide]") {
  namespace conversion = serial::conversion;
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
      const CellRange cells = grid.cells_of({{box[0], box[1], box[2]}, {box[3], box[4], box[5]}});
      REQUIRE(cells == CellRange{{plain[0], plain[1], plain[2]}, {plain[3], plain[4], plain[5]}});
    }
  }
  REQUIRE(n_good > 1000);
  REQUIRE(n_inside_out > 1000);  // nothing else is wrong with these
  REQUIRE(n_nan > 500);
}

TEST_CASE("in a crowded voxel of two models only pairs across the models are found, each once",
          "[collide]") {
  auto items = random_scene(11, 1500, 0, 1, false);
  for (std::size_t i = 0; i < items.size(); ++i) {
    items[i].id.model = static_cast<ModelId>(i % 5 == 0 ? 1 : 0);
    if (i % 5 == 0) items[i].box.hi = items[i].box.lo;
  }
  const PairRules rules{};
  const Pairs expected = oracle(items, rules);
  REQUIRE(expected.size() > 300);
  for (const double size : {100.0, 3.0, 1.0})
    for (const auto method : {SerialMethod::automatic, SerialMethod::bisection})
      REQUIRE((found(items, VoxelGrid(size), rules, method) == expected));
}

TEST_CASE("errors name bad boxes, coordinates and voxel sizes", "[collide]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const Aabb& box :
       {Aabb{{0, nan, 0}, {1, 1, 1}}, Aabb{{0, 0, 0}, {inf, 1, 1}}, Aabb{{2, 0, 0}, {1, 1, 1}}}) {
    const std::vector<Item> items{item(box, 42, 0)};
    REQUIRE_THROWS_WITH(serial::group_by_voxel(items, VoxelGrid(1)),
                        Catch::Contains("object 42 of owner 7"));
  }
  REQUIRE_THROWS_WITH(VoxelGrid(1).cell_of({1, -3e9, 0}), Catch::Contains("-3e+09"));
  REQUIRE_THROWS_AS(VoxelGrid(1).cell_of({nan, 0, 0}), Error);
  REQUIRE(VoxelGrid(1).cell_of({2147483647.5, -2147483648.0, -5e-324}) ==
          Cell{2147483647, -2147483647 - 1, -1});
  REQUIRE_THROWS_AS(VoxelGrid(0), Error);
  REQUIRE_THROWS_AS(VoxelGrid(nan), Error);
  REQUIRE_THROWS_AS(VoxelGrid(1e-310), Error);
  const std::vector<Item> huge{item({{0, 0, 0}, {1e6, 1e6, 1e6}}, 3, 0)};
  REQUIRE_THROWS_WITH(serial::group_by_voxel(huge, VoxelGrid(1)),
                      Catch::Contains("take larger voxels"));
}

TEST_CASE("the responsible voxel received both objects", "[collide]") {
  const auto items = random_scene(9, 200, 0.1, 0.37, false);
  const VoxelGrid grid({0.05, 0, -0.3}, {0.1, 0.3, 0.7});
  for (const Item& a : items)
    for (const Item& b : items) {
      if (!overlap(a.box, b.box, Touching::counts)) continue;
      const CellRange at = grid.cells_of(a.box), bt = grid.cells_of(b.box);
      REQUIRE(at.contains(serial::responsible(at.lo, bt.lo)));
      REQUIRE(bt.contains(serial::responsible(at.lo, bt.lo)));
    }
}

TEST_CASE("the suggested voxel size is twice the median extent", "[collide]") {
  std::vector<Item> items;
  REQUIRE(suggested_voxel_size(items) == 1);
  for (std::size_t i = 0; i < 9; ++i)
    items.push_back(item({{0, 0, 0}, {1, 0.5, 1.0 + static_cast<double>(i)}}, i, 0));
  REQUIRE(suggested_voxel_size(items) == 10);
}
