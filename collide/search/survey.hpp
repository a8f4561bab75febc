// What is known of the boxes before a search: their bounds, whether all are valid, and how large
// each is.
#pragma once

#include "collide/box.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

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
template <class Real>
inline constexpr std::size_t n_octaves = sizeof(Real) == sizeof(float) ? 256 : 2048;

template <class Real, std::size_t D>
[[nodiscard]] Real longest_extent(const Box<Real, D>& box) noexcept {
  Real longest = 0;
  for (std::size_t k = 0; k < D; ++k) longest = std::max(longest, box.hi[k] - box.lo[k]);
  return longest;
}

/// The bounds of boxes. Throws Error (bad_value) with the position of the first box that is not
/// valid; `set` is "" or " of the second set" and the like.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> checked_bounds(std::span<const Box<Real, D>> boxes, const char* set);

}  // namespace tess::collide::search
