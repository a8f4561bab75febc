// Decides which voxel reports a pair. Two objects may share several voxels, but exactly one voxel
// must report the pair. The rule uses only integers: the responsible voxel of a and b is the
// componentwise maximum of the cells of their lower corners.
//
// Proof that this voxel received both objects: if the closed boxes overlap, then on each axis m =
// max(a.lo, b.lo) satisfies a.lo <= m <= a.hi and b.lo <= m <= b.hi. The map to cells is monotone,
// so cell(m) = max(cell(a.lo), cell(b.lo)) and cell(a.lo) <= cell(m) <= cell(a.hi), likewise for b.
// So the voxel lies in both cell ranges. There is one such voxel for any size and origin of the
// grid, so each pair is reported once. No coordinate is compared with the boundary of a voxel, so
// there is no rounding. (Lawlor and Kalé 2002, section 2, take the midpoint of the centres.)
//
// In a voxel that received both objects, the cell of each lower corner is <= the cell of the voxel
// on every axis. The maximum equals the cell of the voxel if and only if on each axis at least one
// of the two is equal. So an object needs three bits, and a pair one AND.
#pragma once

#include "collide/serial/voxel_grid.hpp"

#include <algorithm>

namespace tess::collide::serial {

/// The voxel that reports a pair of objects whose lower corners lie in the cells `a` and `b`.
[[nodiscard]] inline Cell responsible(const Cell& a, const Cell& b) noexcept {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Bit k is set if `lower` lies below `voxel` on axis k, so that this object does not make the
/// voxel responsible on that axis.
[[nodiscard]] inline std::uint32_t axes_below(const Cell& lower, const Cell& voxel) noexcept {
  return (lower.x != voxel.x ? 1u : 0u) | (lower.y != voxel.y ? 2u : 0u) |
         (lower.z != voxel.z ? 4u : 0u);
}

/// True if the voxel reports a pair of objects with these bits.
[[nodiscard]] inline bool reports(std::uint32_t a_below, std::uint32_t b_below) noexcept {
  return (a_below & b_below) == 0;
}

}  // namespace tess::collide::serial
