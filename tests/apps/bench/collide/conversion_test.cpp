// The conversions that the library uses are right where a conversion can go wrong; the one of the
// paper is wrong where the table says so.
#include "apps/bench/collide/conversion.hpp"

#include "collide/problem/region_grid.hpp"
#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace bench;

namespace {

const Conversion& named(std::string_view name) {
  return *std::find_if(conversions().begin(), conversions().end(),
                       [&](const Conversion& each) { return each.name == name; });
}

}  // namespace

TEST_CASE("the library's conversions are right on faces, for negatives and out of range",
          "[apps][bench][collide]") {
  for (const char* name : {"pairs", "chares"}) {
    INFO(name);
    CHECK(errors_on_faces(named(name)).n_wrong == 0);
    CHECK(errors_of_negatives(named(name)).n_wrong == 0);
    CHECK(errors_out_of_range(named(name)).n_wrong == 0);
    CHECK(named(name).out_of_range != OutOfRange::wraps);
  }
}

TEST_CASE("every form with a floor is right, and a cast and the paper's constant are not",
          "[apps][bench][collide]") {
  for (const Conversion& form : conversions()) {
    INFO(form.name);
    const ConversionErrors faces = errors_on_faces(form), negatives = errors_of_negatives(form),
                           beyond = errors_out_of_range(form);
    CHECK(faces.n == 2000);
    CHECK(faces.n_wrong == (form.name == "paper" ? 1000 : 0));  // ties round to even
    CHECK(negatives.n == 1000);
    CHECK(negatives.n_wrong == (form.name == "cast" ? 1000 : 0));
    CHECK(beyond.n > 100);
    CHECK(beyond.n_wrong == (form.out_of_range == OutOfRange::wraps ? beyond.n : 0));
  }
}

TEMPLATE_TEST_CASE("a cell of the serial face never decreases with the coordinate",
                   "[apps][bench][collide]", float, double) {
  using namespace tess::collide;
  using Real = TestType;
  tess::Random random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Real lo = static_cast<Real>(std::ldexp(random.unit() - 0.5, trial % 40 - 20));
    const Real hi = lo + static_cast<Real>(std::ldexp(random.unit(), trial % 30 - 15));
    const auto n = static_cast<std::int32_t>(1 + random.below(1000));
    const search::RegionGrid<Real, 3> grid({{lo, lo, lo}, {hi, hi, hi}}, {n, n, n});
    // About a face of a cell, or of the whole grid.
    Real x = lo + (hi - lo) * static_cast<Real>(random.below(1 + static_cast<std::uint64_t>(n))) /
                      static_cast<Real>(n);
    std::int32_t before = 0;
    x = std::nextafter(std::nextafter(x, -std::numeric_limits<Real>::max()),
                       -std::numeric_limits<Real>::max());
    for (int step = 0; step < 5; ++step) {
      const Box<Real, 3> point{{x, x, x}, {x, x, x}};
      const Box<std::int32_t, 3> cells = grid.cells(point);
      for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(cells.lo[k] == grid.cell(x, k));
        REQUIRE(cells.hi[k] == grid.cell(x, k));
      }
      REQUIRE(cells.lo[0] >= before);
      REQUIRE(cells.lo[0] < n);
      before = cells.lo[0];
      x = std::nextafter(x, std::numeric_limits<Real>::max());
    }
  }
}
