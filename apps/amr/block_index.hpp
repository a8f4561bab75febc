// Blocks of an oct-tree over the periodic unit cube, named by their path from the root: a bit
// vector of a leading one and three bits per level, the halves of x, y and z that the block is in.
//
//     1        the root          1 ooo        one of its eight children
//     1 ooo ppp   child ppp of that child, at level 2, and so on to level 20
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace amr {

/// 2 × axis, plus 1 for the upper side.
using Face = std::int32_t;
inline constexpr std::int32_t n_faces = 6, n_octants = 8, n_quadrants = 4;

/// The half of a block along an axis that its child `octant` is in.
[[nodiscard]] constexpr std::int32_t half(std::int32_t octant, std::int32_t axis) {
  return (octant >> axis) & 1;
}
/// The quarter of a face across `axis` that the child touches: bit 0 is its half along the next
/// axis, bit 1 along the one after that.
[[nodiscard]] constexpr std::int32_t quadrant_of(std::int32_t octant, std::int32_t axis) {
  return half(octant, (axis + 1) % 3) | half(octant, (axis + 2) % 3) << 1;
}
/// The child that touches a quarter of a face.
[[nodiscard]] constexpr std::int32_t octant_at(Face face, std::int32_t quadrant) {
  const std::int32_t axis = face / 2;
  return (face & 1) << axis | (quadrant & 1) << (axis + 1) % 3 | (quadrant >> 1) << (axis + 2) % 3;
}
/// True if the child's face is on the outside of its parent.
[[nodiscard]] constexpr bool is_outer(std::int32_t octant, Face face) {
  return half(octant, face / 2) == (face & 1);
}

struct BlockIndex {
  std::uint64_t path = 1;

  [[nodiscard]] std::int32_t level() const {
    return (static_cast<std::int32_t>(std::bit_width(path)) - 1) / 3;
  }
  [[nodiscard]] std::int32_t octant() const { return static_cast<std::int32_t>(path & 7U); }
  [[nodiscard]] BlockIndex parent() const { return {path >> 3U}; }
  [[nodiscard]] BlockIndex child(std::int32_t octant) const {
    return {path << 3U | static_cast<std::uint64_t>(octant)};
  }
  /// The place among the 2^level blocks of this level along each axis.
  [[nodiscard]] std::array<std::int32_t, 3> coordinates() const;
  [[nodiscard]] static BlockIndex at(std::int32_t level, const std::array<std::int32_t, 3>& place);
  /// The place of its first descendants along the curve of all paths, from 0 to 1.
  [[nodiscard]] double along() const;
  /// The block of the same level behind a face; the cube is periodic.
  [[nodiscard]] BlockIndex neighbour(Face face) const;

  friend auto operator<=>(const BlockIndex&, const BlockIndex&) = default;
};

}  // namespace amr
