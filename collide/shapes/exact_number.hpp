// Exact arithmetic for the cases in which rounding decides a sign. A number is an integer of several
// 64-bit limbs times a power of 2^64, so sums, differences and products of doubles are exact for
// every finite double: no overflow, no underflow. Expansions of doubles (Priest 1991, Shewchuk 1997)
// cost the same, but their products leave the range of a double, and then they are wrong.
//
//     value = ± (limb[0] + limb[1] 2^64 + limb[2] 2^128 + …) 2^(64 place)
//
// Polynomials up to degree 6 in differences of coordinates fit. Any thread; no heap.
#pragma once

#include <array>
#include <cstdint>

namespace tess::collide::shapes {

class ExactNumber {
 public:
  /// Zero.
  ExactNumber() noexcept {}  // NOLINT: limbs beyond size_ have no value
  /// `value` is finite.
  explicit ExactNumber(double value) noexcept;
  ExactNumber(const ExactNumber& other) noexcept { *this = other; }
  ExactNumber& operator=(const ExactNumber& other) noexcept;

  /// -1, 0 or 1.
  [[nodiscard]] int sign() const noexcept { return size_ == 0 ? 0 : is_negative_ ? -1 : 1; }
  /// The quotient of two numbers to a relative error below 2^-50. The divisor is not zero.
  [[nodiscard]] static double quotient(const ExactNumber& a, const ExactNumber& b) noexcept;

  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) noexcept {
    return sum(a, b, b.is_negative_);
  }
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) noexcept {
    return sum(a, b, !b.is_negative_);
  }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) noexcept;

 private:
  // A double lies in 33 places, a difference in 34, and a product of six differences in 204.
  static constexpr int capacity = 208;

  struct Scaled {  // value = fraction 2^exponent
    double fraction;
    int exponent;
  };

  /// a + b, where b has the given sign.
  static ExactNumber sum(const ExactNumber& a, const ExactNumber& b, bool b_is_negative) noexcept;
  /// The limb at `place`; zero outside the number.
  [[nodiscard]] std::uint64_t at(int place) const noexcept {
    const int i = place - place_;
    return i < 0 || i >= size_ ? 0 : limbs_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] Scaled scaled() const noexcept;
  void trim() noexcept;

  std::array<std::uint64_t, capacity> limbs_;  // first and last are not zero
  int size_ = 0;
  int place_ = 0;
  bool is_negative_ = false;
};

}  // namespace tess::collide::shapes
