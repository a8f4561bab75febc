#include "m2m/partition/hilbert.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace tess::m2m {
namespace {

constexpr unsigned rotated_left(unsigned bits, unsigned by) {
  by %= 3;
  return (bits << by | bits >> (3 - by)) & 7U;
}
constexpr unsigned rotated_right(unsigned bits, unsigned by) {
  return rotated_left(bits, 3 - by % 3);
}
constexpr unsigned gray(unsigned i) {
  return i ^ i >> 1U;
}

/// One level of the curve: what a state makes of the three bits of a cell.
struct Step {
  std::uint8_t digit;  // of the position
  std::uint8_t state;  // within the cell; a multiple of 8
};
/// Per state (an entry corner and a direction) and bits of a cell.
constexpr auto make_steps() {
  std::array<Step, std::size_t{24} * 8> steps{};
  for (unsigned entry = 0; entry < 8; ++entry) {
    for (unsigned direction = 0; direction < 3; ++direction) {
      for (unsigned w = 0; w < 8; ++w) {
        const unsigned cell = rotated_left(gray(w), direction + 1) ^ entry;
        const unsigned local_entry = w == 0 ? 0 : gray(2 * ((w - 1) / 2));
        unsigned turn = 0;
        if (w != 0) turn = static_cast<unsigned>(std::countr_one(w % 2 == 0 ? w - 1 : w)) % 3;
        const unsigned next_entry = entry ^ rotated_left(local_entry, direction + 1);
        const unsigned next_direction = (direction + turn + 1) % 3;
        steps[(entry * 3 + direction) * 8 + cell] = {
            static_cast<std::uint8_t>(w),
            static_cast<std::uint8_t>((next_entry * 3 + next_direction) * 8)};
      }
    }
  }
  return steps;
}
constexpr auto steps = make_steps();

/// Moves bit i of 21 bits to bit 3i.
constexpr std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32U) & 0x001f00000000ffffU;
  x = (x | x << 16U) & 0x001f0000ff0000ffU;
  x = (x | x << 8U) & 0x100f00f00f00f00fU;
  x = (x | x << 4U) & 0x10c30c30c30c30c3U;
  return (x | x << 2U) & 0x1249249249249249U;
}

}  // namespace

HilbertCube::HilbertCube(const Aabb& box) : low_(box.lo) {
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) side = std::max(side, box.hi[axis] - box.lo[axis]);
  if (side > 1e-290) cells_per_length_ = 0x1p21 / side;
}

std::uint64_t HilbertCube::cell(const Point& p) const {
  std::array<std::uint64_t, 3> bits{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = (p[axis] - low_[axis]) * cells_per_length_;
    bits[axis] = spread(static_cast<std::uint64_t>(std::clamp(at, 0.0, 0x1p21 - 1)));
  }
  return bits[0] << 2U | bits[1] << 1U | bits[2];
}

std::uint64_t hilbert_position(std::uint64_t cell, int levels) {
  std::uint64_t position = 0;
  unsigned state = 0;
  for (int level = 1; level <= levels; ++level) {
    const Step step = steps[state + (cell >> (3 * (hilbert_levels - level)) & 7U)];
    position = position << 3U | step.digit;
    state = step.state;
  }
  return position;
}

}  // namespace tess::m2m
