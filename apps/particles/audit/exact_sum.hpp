// A sum of doubles without rounding: energies come out the same for every order in which particles,
// blocks and PEs are added. A fixed-point number wide enough for all doubles (Kulisch): 32 bits a
// limb, each limb in 64 bits, so that carries wait until there have been 2³⁰ additions.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace particles {

class ExactSum {
 public:
  /// Values that are not finite are added to one another alone: see total().
  void add(double value) {
    if (!std::isfinite(value)) beyond_ += value;
    if (value == 0 || !std::isfinite(value)) return;
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);  // ±[1/2, 1)
    const auto bits = static_cast<std::int64_t>(std::ldexp(fraction, 53));
    const int shift = exponent - 53 + bias;  // of the lowest bit, at least 0
    const auto limb = static_cast<std::size_t>(shift) / 32;
    const unsigned offset = static_cast<unsigned>(shift) % 32;
    const bool negative = bits < 0;
    const auto size = static_cast<std::uint64_t>(negative ? -bits : bits);
    const std::uint64_t low = size << offset, high = offset == 0 ? 0 : size >> (64 - offset);
    const std::array<std::uint64_t, 3> parts{low & 0xFFFFFFFFU, low >> 32U, high};
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto part = static_cast<std::int64_t>(parts[i]);
      limbs_[limb + i] += negative ? -part : part;
    }
    if (++n_added_ == most) carry();
  }
  void add(const ExactSum& other) {
    carry();
    ExactSum small = other;
    small.carry();
    for (std::size_t i = 0; i < limbs_.size(); ++i) limbs_[i] += small.limbs_[i];
    beyond_ += small.beyond_;
    carry();
  }
  /// The sum of all values: infinite or not a number where one of them was.
  [[nodiscard]] double total() const {
    if (std::isnan(beyond_)) return NAN;  // of one sign, whatever the order
    return beyond_ == 0 ? value() : beyond_;
  }
  /// The sum of the finite values, rounded in one fixed way: from the highest limb down, after the
  /// carries.
  [[nodiscard]] double value() const {
    ExactSum whole = *this;
    whole.carry();
    const bool negative = whole.limbs_.back() < 0;
    if (negative) {  // the limbs of a negative sum are those of a complement
      for (std::int64_t& limb : whole.limbs_) limb = -limb;
      whole.carry();
    }
    double sum = 0;
    for (std::size_t i = limbs_.size(); i-- > 0;)
      if (whole.limbs_[i] != 0)
        sum += std::ldexp(static_cast<double>(whole.limbs_[i]), static_cast<int>(32 * i) - bias);
    return negative ? -sum : sum;
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(limbs_, n_added_, beyond_);
  }

 private:
  static constexpr int bias = 1074 + 53;
  static constexpr std::uint32_t most = 1U << 30U;

  /// Brings all limbs but the highest into 0 … 2³² − 1: one form for each value.
  void carry() {
    for (std::size_t i = 0; i + 1 < limbs_.size(); ++i) {
      const std::int64_t above = limbs_[i] >> 32U;
      limbs_[i] -= above << 32U;
      limbs_[i + 1] += above;
    }
    n_added_ = 0;
  }

  std::array<std::int64_t, 72> limbs_{};
  std::uint32_t n_added_ = 0;
  double beyond_ = 0;  // ±infinity and NaN add up to the same in every order
};

}  // namespace particles
