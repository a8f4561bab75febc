// Operations on vectors give what a loop over the lanes gives.
#include "runtime/core/simd.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

using namespace tess;

namespace {

template <class Number>
void check_comparisons() {
  constexpr std::size_t n = simd::widest / sizeof(Number);
  using V = simd::Vector<Number, n>;
  std::mt19937 random(1);
  std::array<Number, n> a{}, b{};
  for (int round = 0; round < 1000; ++round) {
    for (Number& x : a) x = static_cast<Number>(random() % 4);
    for (Number& x : b) x = static_cast<Number>(random() % 4);
    const auto among = static_cast<simd::Bits>(random() % (std::uint64_t{1} << n));
    simd::Bits less = 0, less_or_equal = 0, every = 0;
    for (std::size_t i = 0; i < n; ++i) {
      less |= static_cast<simd::Bits>(a[i] < b[i]) << i;
      less_or_equal |= static_cast<simd::Bits>(a[i] <= b[i]) << i;
      every |= simd::Bits{1} << i;
    }
    const V va = simd::load<V>(a.data()), vb = simd::load<V>(b.data());
    REQUIRE(simd::less<false>(among, va, vb) == (less & among));
    REQUIRE(simd::less<true>(among, va, vb) == (less_or_equal & among));
    REQUIRE(simd::less<true>(every, va, vb) == less_or_equal);
    REQUIRE(simd::any(va < vb) == (less != 0));
    const V least = simd::min(va, vb), greatest = simd::max(va, vb);
    for (std::size_t i = 0; i < n; ++i) {
      REQUIRE(least[i] == std::min(a[i], b[i]));
      REQUIRE(greatest[i] == std::max(a[i], b[i]));
    }
  }
}

template <std::size_t n>
void check_numbers() {
  using V = simd::Vector<std::uint32_t, n>;
  std::mt19937 random(2);
  std::array<std::uint32_t, n> a{};
  for (int round = 0; round < 1000; ++round) {
    for (std::uint32_t& x : a) x = static_cast<std::uint32_t>(random() % 8);
    const auto among = static_cast<simd::Bits>(random() % (std::uint64_t{1} << n));
    simd::Bits disjoint = 0, differ = 0;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < n; ++i) {
      disjoint |= static_cast<simd::Bits>((a[i] & 5U) == 0) << i;
      differ |= static_cast<simd::Bits>(a[i] != 3) << i;
      if ((among >> i & 1U) != 0) kept.push_back(a[i]);
    }
    const V v = simd::load<V>(a.data());
    REQUIRE(simd::disjoint(among, v, simd::all<V>(5)) == (disjoint & among));
    REQUIRE(simd::differ(among, v, simd::all<V>(3)) == (differ & among));
    std::array<std::uint32_t, n> out{};
    std::uint32_t* const end = simd::compress(out.data(), among, v);
    REQUIRE(std::vector(out.data(), end) == kept);
  }
}

}  // namespace

TEST_CASE("comparisons of vectors give a bit per lane", "[runtime]") {
  check_comparisons<float>();
  check_comparisons<double>();
  check_comparisons<std::int32_t>();
  check_numbers<simd::widest / 4>();
  if constexpr (simd::widest > 16) check_numbers<simd::widest / 8>();
}

TEST_CASE("only the first lanes are read where the others are beyond the end", "[runtime]") {
  using V = simd::Vector<double, simd::widest / 8>;
  const std::vector<double> one{7};
  const auto v = simd::load_first<V, 1>(one.data());
  for (std::size_t i = 0; i < simd::n_lanes<V>; ++i) REQUIRE(v[i] == (i == 0 ? 7 : 0));
}

TEST_CASE("a number that is NaN gives way to the second one", "[runtime]") {
  using V = simd::Vector<double, simd::widest / 8>;
  const V nan = simd::all<V>(std::numeric_limits<double>::quiet_NaN()), two = simd::all<V>(2);
  REQUIRE(simd::bits(simd::min(nan, two) == two) == simd::bits(two == two));
  REQUIRE(simd::bits(simd::max(nan, two) == two) == simd::bits(two == two));
}
