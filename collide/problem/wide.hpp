// The few vector operations of the search: comparisons of `width` numbers at a time, with one bit
// per number as the result. They only compare numbers, so every instruction set gives the same bits
// (a test compares them with loops).
#pragma once

#include "runtime/core/simd.hpp"

#include <array>

namespace tess::collide::search {

/// One bit per lane.
using Mask = simd::Bits;

template <class Real>
struct Wide {
  static constexpr std::size_t width = simd::widest / sizeof(Real);
  using Register = simd::Vector<Real, width>;
  using Numbers = simd::Vector<std::uint32_t, width>;

  static Register load(const Real* from) noexcept { return simd::load<Register>(from); }
  static Register all(Real x) noexcept { return simd::all<Register>(x); }
  /// The greater and the lesser of two numbers, per lane.
  static Register greater(Register a, Register b) noexcept { return simd::max(a, b); }
  static Register lesser(Register a, Register b) noexcept { return simd::min(a, b); }
  /// The lanes of `among` in which a <= b, or a < b.
  template <bool or_equal>
  static Mask less(Mask among, Register a, Register b) noexcept {
    return simd::less<or_equal>(among, a, b);
  }
  /// The lanes of `among` in which no bit of `bits` is set.
  static Mask disjoint(Mask among, const std::uint32_t* from, std::uint32_t bits) noexcept {
    return simd::disjoint(among, simd::load<Numbers>(from), simd::all<Numbers>(bits));
  }
  /// The lanes of `among` that differ from `value`.
  static Mask differ(Mask among, const std::uint32_t* from, std::uint32_t value) noexcept {
    return simd::differ(among, simd::load<Numbers>(from), simd::all<Numbers>(value));
  }
  /// Writes `value` to all of `width` places.
  static void fill(std::uint32_t* out, std::uint32_t value) noexcept {
    simd::store(out, simd::all<Numbers>(value));
  }
  /// Writes the objects of the entries of the lanes in `which` to `out`, which has room for `width`.
  /// Returns their end.
  static std::uint32_t* compress(std::uint32_t* out, Mask which,
                                 const std::uint32_t* from) noexcept {
    return simd::compress(out, which, simd::load<Numbers>(from) >> 4);
  }
};
/// The cells of an object that has one or two on each axis, written without a branch: cell c has
/// bit k set if it is the second one on axis k.
template <std::size_t D>
class Corners {
 public:
  static constexpr std::size_t n = std::size_t{1} << D;

  /// `strides`: what a step along each axis adds to the number of a cell.
  explicit Corners(const std::array<std::uint32_t, D>& strides) noexcept {
    for (std::uint32_t c = 0; c < n; ++c) {
      corner_[c] = c;
      offset_[c] = 0;
      for (std::size_t k = 0; k < D; ++k) offset_[c] += (c >> k & 1U) * strides[k];
    }
  }
  /// Writes cell numbers, and entries that have the corner's bits added, each with room for n;
  /// returns how many. `two`: the axes with two cells.
  std::size_t write(std::uint32_t first_cell, std::uint32_t entry, std::uint32_t two,
                    std::uint32_t* cells, std::uint32_t* entries) const noexcept {
    if constexpr (simd::has_compress && D <= 3) {
      using Numbers = simd::Vector<std::uint32_t, 8>;
      const Numbers corner = simd::load<Numbers>(corner_.data());
      const simd::Bits used = simd::disjoint((1U << n) - 1, corner, simd::all<Numbers>(~two));
      simd::compress(cells, used, simd::load<Numbers>(offset_.data()) + first_cell);
      return static_cast<std::size_t>(simd::compress(entries, used, corner | entry) - entries);
    }
    std::size_t at = 0;
    for (std::uint32_t c = 0; c < n; ++c) {
      cells[at] = first_cell + offset_[c];
      entries[at] = entry | c;
      at += (c & ~two) == 0 ? 1 : 0;
    }
    return at;
  }
  /// Room that write() needs behind the last entry.
  static constexpr std::size_t room = n < 8 ? 8 : n;

 private:
  alignas(32) std::array<std::uint32_t, room> corner_{}, offset_{};
};

}  // namespace tess::collide::search
