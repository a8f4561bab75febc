// An object in a voxel, in four bytes: the position of the object, and one bit per axis that says
// whether its lower corner lies below the voxel.
//
// The bits decide which of the voxels that two objects share reports the pair: the componentwise
// maximum of the cells of their lower corners. Proof that this voxel has both objects: if the
// closed boxes overlap, then on each axis m = max(a.lo, b.lo) satisfies a.lo <= m <= a.hi and
// b.lo <= m <= b.hi. The map from coordinates to cells is monotone, so cell(m) = max(cell(a.lo),
// cell(b.lo)) lies in both ranges of cells. In a voxel that has both objects, the cells of their
// lower corners are at most the voxel's; so the voxel is the maximum if and only if on no axis both
// lower corners lie below it: one AND. Only integers are compared, and no rounding is possible.
//
// A voxel may be divided again, by any monotone map of its own. A bit that is set remains set in
// all parts: if both lower corners lie below the voxel, no part of it reports the pair. Otherwise
// the greater of the two lies in the voxel, hence in exactly one part. (Lawlor and Kalé 2002,
// section 2, take the midpoint of the centres.)
#pragma once

#include <cstdint>

namespace tess::collide::search {

enum class Entry : std::uint32_t {};

/// Entries hold up to 2^28 objects.
inline constexpr std::uint64_t most_objects = std::uint64_t{1} << 28;

[[nodiscard]] constexpr Entry make_entry(std::uint32_t object, std::uint32_t below) noexcept {
  return static_cast<Entry>(object << 4 | below);
}
[[nodiscard]] constexpr std::uint32_t object_of(Entry entry) noexcept {
  return static_cast<std::uint32_t>(entry) >> 4;
}
[[nodiscard]] constexpr std::uint32_t below_of(Entry entry) noexcept {
  return static_cast<std::uint32_t>(entry) & 0xFU;
}

}  // namespace tess::collide::search
