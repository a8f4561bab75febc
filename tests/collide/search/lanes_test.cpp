// Vector code and plain code give the same bits.
#include "collide/search/lanes.hpp"

#include "collide/search/grid.hpp"
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

}  // namespace

TEST_CASE("a comparison with vectors finds what overlap() finds", "[collide]") {
  check_compare<float, Touching::counts>();
  check_compare<float, Touching::does_not_count>();
  check_compare<double, Touching::counts>();
  check_compare<double, Touching::does_not_count>();
}

TEST_CASE("the plain form of each vector operation agrees with the widest one", "[collide]") {
  using Plain = PlainWide<double, Wide<double>::width>;
  constexpr std::size_t width = Wide<double>::width;
  constexpr Mask all = (Mask{1} << width) - 1;
  std::mt19937_64 random(2);
  std::array<double, width> a{}, b{};
  std::array<std::uint32_t, 16> bits{};
  for (int round = 0; round < 1000; ++round) {
    for (double& x : a) x = static_cast<double>(random() % 4);
    for (double& x : b) x = static_cast<double>(random() % 4);
    for (std::uint32_t& x : bits) x = static_cast<std::uint32_t>(random() % 8);
    const auto va = Wide<double>::load(a.data()), vb = Wide<double>::load(b.data());
    const auto pa = Plain::load(a.data()), pb = Plain::load(b.data());
    const Mask among = static_cast<Mask>(random()) & all;
    REQUIRE(Wide<double>::less<true>(among, va, vb) == Plain::less<true>(among, pa, pb));
    REQUIRE(Wide<double>::less<false>(among, va, vb) == Plain::less<false>(among, pa, pb));
    REQUIRE(Wide<double>::disjoint(among, bits.data(), 5) ==
            Plain::disjoint(among, bits.data(), 5));
    REQUIRE(Wide<double>::differ(among, bits.data(), 3) == Plain::differ(among, bits.data(), 3));
    std::array<std::uint32_t, 16> wide{}, plain{};
    const auto n = Wide<double>::compress(wide.data(), among, bits.data()) - wide.data();
    REQUIRE(n == Plain::compress(plain.data(), among, bits.data()) - plain.data());
    REQUIRE(std::equal(wide.begin(), wide.begin() + n, plain.begin()));
  }
}

TEST_CASE("a grid gives the cell of a coordinate, clamped, with vectors and without", "[collide]") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Grid<double, 3> grid({{0, -1, 1e12}, {1, 1, 1e12 + 1}}, {10, 7, 3});
  std::mt19937_64 random(3);
  const std::array values{-inf, -1e300, -1.0, -1e-9,      0.0,   0.1, 0.3,
                          0.7,  1.0,    1e12, 1e12 + 0.5, 1e300, inf};
  for (int round = 0; round < 2000; ++round) {
    Aabb box{};
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = values[random() % values.size()];
      box.hi[k] = std::max(box.lo[k], values[random() % values.size()]);
    }
    const CellRange<3> cells = grid.cells(box);
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(cells.lo[k] == grid.cell(box.lo[k], k));
      REQUIRE(cells.hi[k] == grid.cell(box.hi[k], k));
      REQUIRE(0 <= cells.lo[k]);
      REQUIRE(cells.lo[k] <= cells.hi[k]);
      REQUIRE(cells.hi[k] < grid.n_cells()[k]);
    }
  }
}
