// A field in half (16³) to a twenty-first (256³) of the memory: two levels, blocks of 4³ to 16³ voxels,
// each divided into equal cells as coarse as the error bound allows (section 3.2).
//
//     block (i >> e, j >> e, k >> e)  ->  first entry << 3 | s; cells of 2^s voxels, s up to e
//
//     entry                           ->  distance at the cell's middle, normal
//
// An entry is a plane equation: the distance of a voxel is that of its centre from the plane, cut
// off at the thickness. A sample takes the same few steps for every division, without a branch.
// Read-only once made; any thread. There is no trilinear look-up.
#pragma once

#include "collide/dn_field/field.hpp"

namespace tess::dn {

/// The largest error of a compressed voxel. Any normal fits a voxel without one.
struct ErrorBound {
  double distance = 0;  ///< in the object's units
  double angle = 0;     ///< radians
};

/// The 32 bits of an entry: two coordinates of `normal_bits` bits on the octahedral map, 0 …
/// 2 middle(); mask() in the first means no normal. The rest is the distance in steps, plus zero().
struct EntryLayout {
  int normal_bits = 0;
  float step = 0;

  [[nodiscard]] std::int32_t mask() const { return (1 << normal_bits) - 1; }
  [[nodiscard]] std::int32_t middle() const { return mask() >> 1; }
  [[nodiscard]] std::int32_t zero() const { return 1 << (31 - 2 * normal_bits); }
};

/// The voxels of a compressed field.
struct Planes {
  int block_shift = 2;            ///< e: blocks of 2^e voxels on each axis
  std::array<int, 3> n_blocks{};  ///< n / 2^e, rounded up
  EntryLayout layout;
  std::vector<std::uint32_t> block;  ///< n_blocks, x fastest
  std::vector<std::uint32_t> entry;
  ErrorBound bound;     ///< asked for
  ErrorBound measured;  ///< the greatest over all voxels; never above bound

  [[nodiscard]] std::size_t bytes() const {
    return (block.size() + entry.size()) * sizeof(std::uint32_t);
  }
};

/// Compresses `field` so that every voxel meets `bound`, and measures it on all voxels, with the
/// look-up's own arithmetic. The result has the jump of `field`. block_shift 2 to 4, or 0: the one
/// that takes least memory; larger blocks are tried while they take less. Throws
/// Error(bad_argument) for a field without normals, for a bound that is negative, NaN or below what
/// 32 bits hold (about a thousandth of the thickness, and a third of a degree), or for another
/// block_shift.
[[nodiscard]] Field compress(const Field& field, const ErrorBound& bound, int block_shift = 0);

/// The distance of voxel (i, j, k), flat or compressed.
[[nodiscard]] float voxel_distance(const Field& field, int i, int j, int k);

/// Its normal, unit or zero where it has none. The field stores normals.
[[nodiscard]] Vec3 voxel_normal(const Field& field, int i, int j, int k);

/// The largest error of a voxel's distance by compression.
[[nodiscard]] inline double compression_error(const Field& field) {
  return field.planes != nullptr ? field.planes->measured.distance : 0;
}

}  // namespace tess::dn
