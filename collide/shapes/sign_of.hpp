// The sign of a polynomial, exactly. The formula is written once. It is evaluated in double with a
// bound of the error, and again in exact numbers only if the bound does not decide the sign.
//
//     sign_of([&](auto number) { return number(a) * number(b) - number(c) * number(d); })
#pragma once

#include "collide/shapes/exact_number.hpp"

#include <cmath>

namespace tess::collide::shapes {

/// A double and a bound of its error (running error analysis: Higham 2002, section 3.3). An
/// overflow makes the bound infinite or NaN.
struct RoundedNumber {
  static constexpr double unit = 0x1p-53;
  static constexpr double smallest = 0x1p-1000;  // above all that a product loses by underflow

  double value = 0;
  double error = 0;

  friend RoundedNumber operator+(RoundedNumber a, RoundedNumber b) noexcept {
    const double sum = a.value + b.value;
    return {sum, a.error + b.error + unit * std::abs(sum)};
  }
  friend RoundedNumber operator-(RoundedNumber a, RoundedNumber b) noexcept {
    return a + RoundedNumber{-b.value, b.error};
  }
  friend RoundedNumber operator*(RoundedNumber a, RoundedNumber b) noexcept {
    const double product = a.value * b.value;
    return {product, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error +
                         unit * std::abs(product) + smallest};
  }
  /// Whether the value is certain to `share` of it. The bound itself is rounded, hence the factor.
  [[nodiscard]] bool is_within(double share) const noexcept {
    return std::abs(value) * share > error * (1 + 0x1p-40);
  }
};

/// -1, 0 or 1. `formula` takes a function that makes a number of a double, and returns a number.
template <class Formula>
[[nodiscard]] int sign_of(const Formula& formula) noexcept {
  const RoundedNumber rounded = formula([](double x) noexcept { return RoundedNumber{x, 0}; });
  if (rounded.is_within(1)) return rounded.value > 0 ? 1 : -1;
  return formula([](double x) noexcept { return ExactNumber(x); }).sign();
}

/// over / under to a relative error below 2^-44, however much cancels. `under` is not zero.
template <class Over, class Under>
[[nodiscard]] double ratio(const Over& over, const Under& under) noexcept {
  const auto rounded = [](double x) noexcept { return RoundedNumber{x, 0}; };
  const RoundedNumber a = over(rounded), b = under(rounded);
  if (a.is_within(0x1p-46) && b.is_within(0x1p-46)) return a.value / b.value;
  const auto exact = [](double x) noexcept { return ExactNumber(x); };
  return ExactNumber::quotient(over(exact), under(exact));
}

}  // namespace tess::collide::shapes
