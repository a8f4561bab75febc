// The cells of an object that touches one or two of them on each axis, as nearly all objects do.
#pragma once

#include "runtime/core/simd.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tess::collide::search {

/// Writes them without a branch: cell c has bit k set if it is the second one on axis k.
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
