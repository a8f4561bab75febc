// Vector code and loops give the same bits.
#include "collide/search/lanes.hpp"

#include "collide/problem/region_grid.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace tess::collide;
using namespace tess::collide::search;

namespace {

template <class Real>
std::vector<Box<Real, 3>> boxes_on_lattice(std::size_t n) {
  std::mt19937_64 random(1);
  std::vector<Box<Real, 3>> boxes(n);
  for (Box<Real, 3>& box : boxes)
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = static_cast<Real>(random() % 6);
      box.hi[k] = box.lo[k] + static_cast<Real>(random() % 4);
    }
  return boxes;
}

/// The partners that compare() finds for every box, and those that overlap() does.
template <class Real, Touching touching>
void check_compare() {
  const auto boxes = boxes_on_lattice<Real>(77);
  Lanes<Real, 3> lanes;
  lanes.resize(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    lanes.set(i, boxes[i], make_entry(i, i % 5));
    lanes.set_model(i, i % 3);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found, expected;
  detail::PairSink sink{&found, [](void* to, const std::uint32_t* a, const std::uint32_t* b,
                                   std::size_t n, bool /*swapped*/) {
                          for (std::size_t i = 0; i < n; ++i)
                            static_cast<decltype(found)*>(to)->emplace_back(a[i], b[i]);
                        }};
  PairBuffer out(sink);
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    out.prepare(boxes.size(), false);
    lanes.template compare<touching, true>(lanes.probe(i), i / 2, boxes.size(), out);
    for (std::uint32_t j = i / 2; j < boxes.size(); ++j)
      if (overlap(boxes[i], boxes[j], touching) && (i % 5 & j % 5) == 0 && i % 3 != j % 3)
        expected.emplace_back(i, j);
  }
  out.flush();
  REQUIRE(expected.size() > 30);
  REQUIRE((found == expected));
}

template <class Real, std::size_t D>
void check_code(const RegionGrid<Real, D>& grid, const Box<Real, D>& box) {
  const Box<std::int32_t, D> cells = grid.cells(box);
  std::uint32_t two = 0;
  bool has_more = false;
  for (std::size_t k = 0; k < D; ++k) {
    two |= cells.hi[k] != cells.lo[k] ? 1U << k : 0U;
    has_more = has_more || cells.hi[k] - cells.lo[k] > 1;
  }
  REQUIRE(grid.code(box) == (has_more ? grid.large : grid.number(cells.lo) << D | two));
}

}  // namespace

TEST_CASE("a comparison with vectors finds what overlap() finds", "[collide]") {
  check_compare<float, Touching::counts>();
  check_compare<float, Touching::does_not_count>();
  check_compare<double, Touching::counts>();
  check_compare<double, Touching::does_not_count>();
}

TEST_CASE("a grid gives the cell of a coordinate, clamped, with vectors and without", "[collide]") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const RegionGrid<double, 3> grid({{0, -1, 1e12}, {1, 1, 1e12 + 1}}, {10, 7, 3});
  std::mt19937_64 random(3);
  const std::array values{-inf, -1e300, -1.0, -1e-9,      0.0,   0.1, 0.3,
                          0.7,  1.0,    1e12, 1e12 + 0.5, 1e300, inf};
  for (int round = 0; round < 2000; ++round) {
    Aabb box{};
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = values[random() % values.size()];
      box.hi[k] = std::max(box.lo[k], values[random() % values.size()]);
    }
    const Box<std::int32_t, 3> cells = grid.cells(box);
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(cells.lo[k] == grid.cell(box.lo[k], k));
      REQUIRE(cells.hi[k] == grid.cell(box.hi[k], k));
      REQUIRE(0 <= cells.lo[k]);
      REQUIRE(cells.lo[k] <= cells.hi[k]);
      REQUIRE(cells.hi[k] < grid.n_cells()[k]);
    }
    check_code(grid, box);
    const RegionGrid<float, 2> flat({{0, -1}, {1, 1}}, {10, 7});
    check_code(flat, {{static_cast<float>(box.lo[0]), static_cast<float>(box.lo[1])},
                      {static_cast<float>(box.hi[0]), static_cast<float>(box.hi[1])}});
  }
}
