#include "runtime/core/hilbert.hpp"

#include <bit>
#include <utility>

namespace tess {
namespace {

constexpr unsigned gray(unsigned i) {
  return i ^ i >> 1U;
}
constexpr unsigned gray_inverse(unsigned bits) {  // of three bits
  return bits ^ bits >> 1U ^ bits >> 2U;
}

/// How a curve lies in a cube: bit j of a cell, as the curve sees it, is bit from[j] of the cell,
/// negated if bit j of `reversed` is set.
struct Frame {
  std::array<unsigned, 3> from{0, 1, 2};
  unsigned reversed = 0;

  [[nodiscard]] constexpr unsigned operator()(unsigned bits) const {
    unsigned seen = reversed;
    for (unsigned j = 0; j < 3; ++j) seen ^= (bits >> from[j] & 1U) << j;
    return seen;
  }
  /// The frame of a part of the curve that lies like `part` within this one.
  [[nodiscard]] constexpr Frame then(const Frame& part) const {
    Frame out{{}, part.reversed};
    for (unsigned j = 0; j < 3; ++j) {
      out.from[j] = from[part.from[j]];
      out.reversed ^= (reversed >> part.from[j] & 1U) << j;
    }
    return out;
  }
};
constexpr unsigned n_frames = 6 * 8;
constexpr unsigned number(const Frame& frame) {
  return (2 * frame.from[0] + (frame.from[1] > frame.from[2] ? 1 : 0)) * 8 + frame.reversed;
}
constexpr Frame frame_of(unsigned number) {
  const unsigned first = number / 16, low = first == 0 ? 1 : 0, high = 3 - first - low;
  const bool swapped = (number / 8) % 2 != 0;
  return {{first, swapped ? high : low, swapped ? low : high}, number % 8};
}

/// The part of Hamilton's curve in a cell.
constexpr Frame hamilton(unsigned cell) {
  const unsigned w = gray_inverse(cell);
  const unsigned entry = w == 0 ? 0 : gray(2 * ((w - 1) / 2));
  unsigned turn = 1;
  if (w != 0) turn += static_cast<unsigned>(std::countr_one(w % 2 == 0 ? w - 1 : w)) % 3;
  return Frame{{0, 1, 2}, entry}.then({{turn % 3, (turn + 1) % 3, (turn + 2) % 3}, 0});
}

/// The part of Skilling's curve in a cell of n axes, of which the first has the highest bit.
template <unsigned n>
constexpr Frame skilling(unsigned cell) {
  constexpr unsigned first = n - 1;
  Frame part;
  for (unsigned j = n; j-- > 0;) {
    Frame turned;
    if ((cell >> j & 1U) != 0)
      turned.reversed = 1U << first;
    else
      std::swap(turned.from[j], turned.from[first]);
    part = part.then(turned);
  }
  if (std::popcount(cell) % 2 != 0) part.reversed ^= 1U << first;
  return part;
}

/// One level of a curve: what a frame makes of the bits of a cell.
struct Step {
  std::uint16_t digit;  // of the position
  std::uint16_t frame;  // within the cell; a multiple of 8
};
/// Per frame and bits of a cell.
constexpr auto steps_of(Frame (*part)(unsigned)) {
  std::array<Step, std::size_t{n_frames} * 8> steps{};
  for (unsigned f = 0; f < n_frames; ++f)
    for (unsigned cell = 0; cell < 8; ++cell) {
      const unsigned seen = frame_of(f)(cell);
      steps[f * 8 + cell] = {static_cast<std::uint16_t>(gray_inverse(seen)),
                             static_cast<std::uint16_t>(number(frame_of(f).then(part(seen))) * 8)};
    }
  return steps;
}

/// The position of a cell of n axes, from the highest of its levels down.
template <unsigned n, const auto& steps>
std::uint64_t walk(std::uint64_t cell, unsigned levels, unsigned frame) {
  std::uint64_t position = 0;
  while (levels-- > 0) {
    const Step step = steps[frame + (cell >> (n * levels) & ((1U << n) - 1))];
    position = position << n | step.digit;
    frame = step.frame;
  }
  return position;
}

constexpr auto steps_of_hamilton = steps_of(hamilton);
constexpr auto steps_in_plane = steps_of(skilling<2>), steps_in_space = steps_of(skilling<3>);

}  // namespace

std::uint64_t hilbert_position(std::uint64_t cell, int levels) {
  constexpr unsigned start = number({{1, 2, 0}, 0}) * 8;
  return walk<3, steps_of_hamilton>(cell, static_cast<unsigned>(levels), start);
}

std::uint64_t hilbert_key(const std::array<std::uint32_t, 3>& cell, std::size_t n_axes,
                          unsigned levels) {
  std::uint64_t bits = 0;  // interleaved
  for (unsigned level = levels; level-- > 0;)
    for (std::size_t k = 0; k < n_axes; ++k) bits = bits << 1U | (cell[k] >> level & 1U);
  switch (n_axes) {
    case 2:
      return walk<2, steps_in_plane>(bits, levels, 0);
    case 3:
      return walk<3, steps_in_space>(bits, levels, 0);
    default:
      return bits;  // along a line
  }
}

}  // namespace tess
