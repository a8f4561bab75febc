#include "collide/shapes/orientation.hpp"

#include "tests/collide/shapes/rational.hpp"
#include "tests/support/catch.hpp"

#include <bit>
#include <random>

using namespace tess::collide;
using namespace tess::collide::shapes;
using namespace tess::collide::testing;

namespace {

int exact_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Exact o = exact(a);
  return dot(cross(exact(b) - o, exact(c) - o), exact(d) - o).sign();
}

int exact_orient2d(const Point& a, const Point& b, const Point& c, std::size_t i, std::size_t j) {
  const auto r = [](double x) { return Rational(x); };
  const Rational det =
      (r(b[i]) - r(a[i])) * (r(c[j]) - r(a[j])) - (r(b[j]) - r(a[j])) * (r(c[i]) - r(a[i]));
  return det.sign();
}

}  // namespace

TEST_CASE("orient3d agrees with rational numbers near a plane", "[collide][shapes]") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> some(-1, 1);
  std::size_t n_zero = 0, n_undecided = 0;
  for (int i = 0; i < 4000; ++i) {
    const double scale = std::ldexp(1.0, i % 7 * 20 - 60), offset = i % 3 == 0 ? 1e12 : 0;
    std::array<Point, 4> p{};
    for (Point& q : p)
      for (double& x : q) x = offset + scale * some(random);
    // The fourth is an affine combination of the others, rounded: in the plane or a few ulp off.
    const double s = some(random), t = i % 5 == 0 ? 0 : some(random);
    for (std::size_t k = 0; k < 3; ++k)
      p[3][k] = p[0][k] + s * (p[1][k] - p[0][k]) + t * (p[2][k] - p[0][k]);
    if (i % 11 == 0) p[3] = p[1];
    const int expected = exact_orient3d(p[0], p[1], p[2], p[3]);
    REQUIRE(orient3d(p[0], p[1], p[2], p[3]) == expected);
    REQUIRE(orient3d(p[1], p[0], p[2], p[3]) == -expected);
    const int certain = Sides(p[0], p[1], p[2]).certain(p[3]);
    REQUIRE((certain == 0 || certain == expected));
    n_zero += expected == 0 ? 1U : 0U;
    n_undecided += certain == 0 ? 1U : 0U;
  }
  CHECK(n_zero > 300);
  CHECK(n_undecided > 3000);
}

TEST_CASE("signs are exact from the smallest denormal to the largest double", "[collide][shapes]") {
  std::mt19937_64 random(5);
  const auto coordinate = [&](int i) {
    for (;;) {
      const auto bits = random();
      const double x = i % 4 == 0   ? std::bit_cast<double>(bits)
                       : i % 4 == 1 ? std::ldexp(double(bits % 5) - 2, -1074)
                       : i % 4 == 2 ? std::ldexp(double(bits % 5) - 2, 1022)
                                    : std::ldexp(double(bits % 5) - 2, int(bits % 2098) - 1074);
      if (std::isfinite(x)) return x;
    }
  };
  int n_nonzero = 0;
  for (int i = 0; i < 2000; ++i) {
    std::array<Point, 4> p{};
    for (Point& q : p)
      for (double& x : q) x = coordinate(i);
    const int expected = exact_orient3d(p[0], p[1], p[2], p[3]);
    REQUIRE(orient3d(p[0], p[1], p[2], p[3]) == expected);
    REQUIRE(orient2d(p[0], p[1], p[2], Dropped::x) == exact_orient2d(p[0], p[1], p[2], 1, 2));
    REQUIRE(orient2d(p[0], p[1], p[2], Dropped::y) == exact_orient2d(p[0], p[1], p[2], 2, 0));
    REQUIRE(orient2d(p[0], p[1], p[2], Dropped::z) == exact_orient2d(p[0], p[1], p[2], 0, 1));
    n_nonzero += std::abs(expected);
  }
  CHECK(n_nonzero > 1000);
}

TEST_CASE("a sum that overflows is not taken for a sign", "[collide][shapes]") {
  // Two products of 1.7e308 overflow together, and the third outweighs them.
  const double x = 0x1p341;
  const Point a{0, 0, 0}, b{x, 0.9 * x, x}, c{-x, x, 0.9 * x};
  for (const Point& d : {Point{1.9 * x, -1.9 * x, -1.9 * x}, Point{-1.9 * x, 1.9 * x, 1.9 * x},
                         Point{1.9 * x, 1.9 * x, -1.9 * x}, Point{x, x, 1.9 * x}})
    CHECK(orient3d(a, b, c, d) == exact_orient3d(a, b, c, d));
}
