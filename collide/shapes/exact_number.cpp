#include "collide/shapes/exact_number.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tess::collide::shapes {
namespace {
__extension__ using Wide = unsigned __int128;
constexpr int limb_bits = 64;
}  // namespace

ExactNumber::ExactNumber(double value) noexcept : is_negative_(std::signbit(value)) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto biased = static_cast<int>(bits >> 52U & 0x7FFU);
  std::uint64_t mantissa = bits & 0xFFFFFFFFFFFFFU;
  if (biased != 0) mantissa |= std::uint64_t{1} << 52U;
  const int exponent = std::max(biased, 1) - 1075;  // value = mantissa 2^exponent
  place_ = (exponent + 64 * limb_bits) / limb_bits - limb_bits;
  const Wide shifted = Wide{mantissa} << static_cast<unsigned>(exponent - place_ * limb_bits);
  limbs_[0] = static_cast<std::uint64_t>(shifted);
  limbs_[1] = static_cast<std::uint64_t>(shifted >> 64U);
  size_ = 2;
  trim();
}

ExactNumber& ExactNumber::operator=(const ExactNumber& other) noexcept {
  if (this == &other) return *this;
  size_ = other.size_;
  place_ = other.place_;
  is_negative_ = other.is_negative_;
  std::copy_n(other.limbs_.begin(), size_, limbs_.begin());
  return *this;
}

void ExactNumber::trim() noexcept {
  while (size_ > 0 && limbs_[static_cast<std::size_t>(size_ - 1)] == 0) --size_;
  int zeros = 0;
  while (zeros < size_ && limbs_[static_cast<std::size_t>(zeros)] == 0) ++zeros;
  if (zeros == 0) return;
  std::copy(limbs_.begin() + zeros, limbs_.begin() + size_, limbs_.begin());
  size_ -= zeros;
  place_ += zeros;
}

ExactNumber ExactNumber::sum(const ExactNumber& a, const ExactNumber& b,
                             bool b_is_negative) noexcept {
  if (b.size_ == 0) return a;
  if (a.size_ == 0) {
    ExactNumber out = b;
    out.is_negative_ = b_is_negative;
    return out;
  }
  ExactNumber out;
  out.place_ = std::min(a.place_, b.place_);
  const int end = std::max(a.place_ + a.size_, b.place_ + b.size_);
  out.size_ = end - out.place_;
  if (a.is_negative_ == b_is_negative) {
    out.is_negative_ = b_is_negative;
    std::uint64_t carry = 0;
    for (int i = 0; i < out.size_; ++i) {
      const Wide s = Wide{a.at(out.place_ + i)} + b.at(out.place_ + i) + carry;
      out.limbs_[static_cast<std::size_t>(i)] = static_cast<std::uint64_t>(s);
      carry = static_cast<std::uint64_t>(s >> 64U);
    }
    if (carry != 0) out.limbs_[static_cast<std::size_t>(out.size_++)] = carry;
  } else {
    int top = end - 1;
    while (top >= out.place_ && a.at(top) == b.at(top)) --top;
    if (top < out.place_) return {};
    const bool a_is_larger = a.at(top) > b.at(top);
    out.is_negative_ = a_is_larger ? a.is_negative_ : b_is_negative;
    const ExactNumber& large = a_is_larger ? a : b;
    const ExactNumber& small = a_is_larger ? b : a;
    out.size_ = top + 1 - out.place_;
    std::uint64_t borrow = 0;
    for (int i = 0; i < out.size_; ++i) {
      const Wide d = Wide{large.at(out.place_ + i)} - small.at(out.place_ + i) - borrow;
      out.limbs_[static_cast<std::size_t>(i)] = static_cast<std::uint64_t>(d);
      borrow = static_cast<std::uint64_t>(d >> 64U) & 1U;
    }
  }
  out.trim();
  return out;
}

ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) noexcept {
  ExactNumber out;
  if (a.size_ == 0 || b.size_ == 0) return out;
  out.is_negative_ = a.is_negative_ != b.is_negative_;
  out.place_ = a.place_ + b.place_;
  out.size_ = a.size_ + b.size_;
  std::fill_n(out.limbs_.begin(), out.size_, 0);
  for (int i = 0; i < a.size_; ++i) {
    std::uint64_t carry = 0;
    const std::uint64_t factor = a.limbs_[static_cast<std::size_t>(i)];
    for (int j = 0; j < b.size_; ++j) {
      std::uint64_t& limb = out.limbs_[static_cast<std::size_t>(i + j)];
      const Wide s = Wide{factor} * b.limbs_[static_cast<std::size_t>(j)] + limb + carry;
      limb = static_cast<std::uint64_t>(s);
      carry = static_cast<std::uint64_t>(s >> 64U);
    }
    out.limbs_[static_cast<std::size_t>(i + b.size_)] = carry;
  }
  out.trim();
  return out;
}

ExactNumber::Scaled ExactNumber::scaled() const noexcept {
  if (size_ == 0) return {0, 0};
  const int top = place_ + size_ - 1;
  const double fraction = std::ldexp(static_cast<double>(at(top)), -limb_bits) +
                          std::ldexp(static_cast<double>(at(top - 1)), -2 * limb_bits);
  return {is_negative_ ? -fraction : fraction, (top + 1) * limb_bits};
}

double ExactNumber::quotient(const ExactNumber& a, const ExactNumber& b) noexcept {
  const Scaled x = a.scaled(), y = b.scaled();
  return std::ldexp(x.fraction / y.fraction, x.exponent - y.exponent);
}

}  // namespace tess::collide::shapes
