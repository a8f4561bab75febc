// The sizes of objects: a bit per octave of their longest extents (search/survey.hpp).
#pragma once

#include "collide/search/survey.hpp"

#include <array>
#include <cstdint>

namespace tess::collide {

class Octaves {
 public:
  static constexpr std::uint32_t n = search::n_octaves<double>;

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

}  // namespace tess::collide
