#include "collide/shapes/exact_number.hpp"

#include "tests/support/catch.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

using boost::multiprecision::cpp_rational, tess::collide::shapes::ExactNumber;

namespace {

int sign(const cpp_rational& x) {
  return x.sign();
}

/// A finite double of any size: denormals, zeros and the largest included.
double any_double(std::mt19937_64& random) {
  for (;;) {
    const auto bits = random();
    double x = std::bit_cast<double>(bits);
    if (bits % 8 == 0) x = std::ldexp(double(bits % 1024), int(bits % 2098) - 1074);
    if (bits % 64 == 1) x = 0;
    if (bits % 64 == 2) x = std::numeric_limits<double>::max();
    if (bits % 64 == 3) x = -std::numeric_limits<double>::denorm_min();
    if (std::isfinite(x)) return x;
  }
}

}  // namespace

TEST_CASE("sums and products of all finite doubles are exact", "[collide][shapes]") {
  std::mt19937_64 random(7);
  for (int i = 0; i < 3000; ++i) {
    const double a = any_double(random), b = any_double(random), c = any_double(random);
    const double d = i % 3 == 0 ? a : any_double(random);
    // The exact values that the library's sign must agree with; (a - d) is zero for each third.
    const cpp_rational x =
        (cpp_rational(a) - cpp_rational(d)) * (cpp_rational(b) + cpp_rational(c));
    const ExactNumber y = (ExactNumber(a) - ExactNumber(d)) * (ExactNumber(b) + ExactNumber(c));
    REQUIRE(y.sign() == sign(x));
    const cpp_rational bound = cpp_rational(a) * cpp_rational(b);
    const ExactNumber limit = ExactNumber(a) * ExactNumber(b);
    REQUIRE((y - limit).sign() == sign(cpp_rational(x - bound)));
    REQUIRE((y - y).sign() == 0);
    REQUIRE((y + limit - y - limit).sign() == 0);
  }
}

TEST_CASE("a product of six differences of the largest and the smallest double fits",
          "[collide][shapes]") {
  const double huge = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const ExactNumber wide = ExactNumber(huge) - ExactNumber(-huge) + ExactNumber(tiny);
  const ExactNumber cube = wide * wide * wide, sixth = cube * cube;
  CHECK(sixth.sign() == 1);
  const ExactNumber tiny_cube = ExactNumber(tiny) * ExactNumber(tiny) * ExactNumber(tiny);
  CHECK((sixth + sixth - sixth - (sixth - tiny_cube * tiny_cube)).sign() == 1);
  CHECK((sixth - sixth * ExactNumber(1)).sign() == 0);
}

TEST_CASE("a quotient is within 2^-50", "[collide][shapes]") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double a = some(random), b = std::ldexp(some(random), i % 300 - 150), c = some(random);
    if (b == 0) continue;
    const double q =
        ExactNumber::quotient(ExactNumber(a) * ExactNumber(c), ExactNumber(b) * ExactNumber(c));
    const cpp_rational error = abs(cpp_rational(q) * cpp_rational(b) - cpp_rational(a));
    REQUIRE(error <= abs(cpp_rational(a)) * cpp_rational(0x1p-50));
  }
}
