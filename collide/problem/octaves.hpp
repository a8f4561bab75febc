// The sizes of objects by their octaves: the powers of two at or below their longest extents.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tess::collide::search {

/// The power of two at or below a size; 0 for zero and the smallest ones.
[[nodiscard]] inline std::uint32_t octave_of(float size) noexcept {
  return std::bit_cast<std::uint32_t>(size) >> 23 & 0xFFU;
}
[[nodiscard]] inline std::uint32_t octave_of(double size) noexcept {
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(size) >> 52 & 0x7FFU);
}
/// The size at which an octave begins.
template <class Real>
[[nodiscard]] Real size_of_octave(std::uint32_t octave) noexcept {
  constexpr int bias = sizeof(Real) == sizeof(float) ? 127 : 1023;
  return std::ldexp(Real{1}, static_cast<int>(octave) - bias);
}

/// A set of octaves of doubles, a bit for each.
class Octaves {
 public:
  static constexpr std::uint32_t n = 2048;

  Octaves() = default;
  /// All octaves up to this one.
  [[nodiscard]] static Octaves up_to(std::uint32_t octave) {
    Octaves out;
    for (std::uint32_t o = 0; o <= octave; ++o) out.add(o);
    return out;
  }

  void add(std::uint32_t octave) { words_[octave / 64] |= std::uint64_t{1} << octave % 64; }
  void add(const Octaves& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
  }
  [[nodiscard]] bool has(std::uint32_t octave) const {
    return (words_[octave / 64] >> octave % 64 & 1U) != 0;
  }
  /// There is at least one.
  [[nodiscard]] std::uint32_t least() const {
    std::uint32_t octave = 0;
    while (!has(octave)) ++octave;
    return octave;
  }
  [[nodiscard]] std::uint32_t greatest() const {
    std::uint32_t octave = n - 1;
    while (!has(octave)) --octave;
    return octave;
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(words_);
  }

 private:
  std::array<std::uint64_t, n / 64> words_{};
};

}  // namespace tess::collide::search
