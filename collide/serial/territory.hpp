// Which voxel reports a pair. Objects that share several voxels meet in each of them; exactly one
// may report. Rule, on integers alone: the responsible voxel of a and b is the componentwise
// maximum of the cells of their lower corners.
//
// Proof that it received both. If the closed boxes overlap, then on each axis m = max(a.lo, b.lo)
// satisfies a.lo <= m <= a.hi and b.lo <= m <= b.hi. The map to cells is monotone, so cell(m) =
// max(cell(a.lo), cell(b.lo)) and cell(a.lo) <= cell(m) <= cell(a.hi), likewise for b: the voxel
// lies in both cell ranges. It is one voxel whatever the size and origin of the grid, so each pair
// is reported once. No coordinate is compared with a voxel's boundary, so no rounding enters
// (Lawlor and Kalé 2002, section 2, take the midpoint of the centres).
//
// In a voxel that received both, each lower cell is <= its own on every axis. The maximum equals it
// iff on each axis at least one of the two is equal: so each object needs three bits, and a pair
// one AND.
#pragma once

#include "collide/serial/voxel_grid.hpp"

#include <algorithm>

namespace tess::collide::serial {

/// The voxel that reports the pair whose lower corners lie in cells `a` and `b`.
[[nodiscard]] inline Cell responsible(const Cell& a, const Cell& b) noexcept {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Bit k is set where `lower` lies below `voxel` on axis k: where this object cannot make the voxel
/// responsible.
[[nodiscard]] inline std::uint32_t axes_below(const Cell& lower, const Cell& voxel) noexcept {
  return (lower.x != voxel.x ? 1u : 0u) | (lower.y != voxel.y ? 2u : 0u) |
         (lower.z != voxel.z ? 4u : 0u);
}

/// Does the voxel report a pair whose objects it received with these bits?
[[nodiscard]] inline bool reports(std::uint32_t a_below, std::uint32_t b_below) noexcept {
  return (a_below & b_below) == 0;
}

}  // namespace tess::collide::serial
