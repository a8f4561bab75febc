// A sum of doubles without rounding: it is the same for every order in which values, elements and
// PEs are added. A reduction of such sums (AddExactSums) gives the same bits for any number of
// elements, where in_order() gives them for any placement of the same elements. A fixed-point
// number wide enough for all doubles (Kulisch): 32 bits per limb, each limb in 64 bits, so that
// carries can wait for 2³⁰ additions. It takes 592 bytes, and an addition about 5 ns.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace tess {

class ExactSum {
 public:
  void add(double value) {
    if (!std::isfinite(value)) beyond_ += value;
    if (value == 0 || !std::isfinite(value)) return;
    const auto image = std::bit_cast<std::uint64_t>(value);
    const std::uint64_t exponent = image >> 52U & 0x7FFU;  // 0: subnormal, of the same unit as 1
    constexpr std::uint64_t implied = std::uint64_t{1} << 52U;
    const std::uint64_t bits = (image & (implied - 1)) | (exponent == 0 ? 0 : implied);
    const std::size_t shift = (exponent == 0 ? 0 : exponent - 1) + lowest;
    const auto wide = static_cast<Wide>(bits) << shift % 32;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto part = static_cast<std::int64_t>(wide >> 32 * i & 0xFFFFFFFFU);
      limbs_[shift / 32 + i] += value < 0 ? -part : part;
    }
    if (++n_added_ == most) carry();
  }
  void add(ExactSum other) {
    carry();
    other.carry();
    for (std::size_t i = 0; i < limbs_.size(); ++i) limbs_[i] += other.limbs_[i];
    beyond_ += other.beyond_;
    carry();
  }
  /// The sum, rounded in one fixed way: from the highest limb down. Infinite or not a number where
  /// one of the values was.
  [[nodiscard]] double total() const {
    if (std::isnan(beyond_)) return NAN;  // of one sign for every order
    if (beyond_ != 0) return beyond_;
    ExactSum whole = *this;
    whole.carry();
    const double sign = whole.limbs_.back() < 0 ? -1 : 1;
    if (sign < 0) {  // the limbs of a negative sum are those of a complement
      for (std::int64_t& limb : whole.limbs_) limb = -limb;
      whole.carry();
    }
    double rounded = 0;
    for (std::size_t i = limbs_.size(); i-- > 0;)
      rounded += std::ldexp(static_cast<double>(whole.limbs_[i]), static_cast<int>(32 * i) - bias);
    return sign * rounded;
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(limbs_, n_added_, beyond_);
  }

 private:
  __extension__ using Wide = unsigned __int128;
  static constexpr int bias = 1074 + 53;
  static constexpr std::size_t lowest = 53;  ///< where the lowest bit of a subnormal number is
  static constexpr std::uint32_t most = 1U << 30U;

  /// Brings all limbs but the highest into 0 … 2³² − 1: one form per value.
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

/// Joins sums in a reduction.
struct AddExactSums {
  ExactSum operator()(ExactSum a, const ExactSum& b) const {
    a.add(b);
    return a;
  }
};

}  // namespace tess
