// A field in a fifth of the memory and less: two levels, blocks of 4³ to 16³ voxels, each divided
// into equal cells as coarse as the error bound lets it (section 3.2).
//
//     block (i >> e, j >> e, k >> e)  ->  first entry << 3 | s; cells of 2^s voxels, s up to e
//
//     entry                           ->  distance at the cell's middle, normal
//
// An entry is a plane equation: a voxel of the cell has the distance of its centre from the plane,
// cut off at the thickness. So a look-up is the same few steps whatever the division, without a
// branch. Read-only once made; any thread.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/look_up.hpp"

#include <span>

namespace tess::dn {

/// How far a compressed voxel may be off the flat one. Voxels without a normal take any.
struct ErrorBound {
  double distance = 0;  ///< in the object's units
  double angle = 0;     ///< radians
};

/// How an entry is written.
struct EntryLayout {
  bool wide = false;    ///< 64 bits: a float and a code of normal_code.hpp; else 32 bits:
  int normal_bits = 0;  ///< on each axis of the octahedral map; the rest is the distance
  float step = 0;       ///< of the distance
};

struct CompressedField {
  Grid grid;
  Method method = Method::exact;
  Sides sides = Sides::one;
  Content content = Content::distance_and_normal;
  double thickness = 0;
  int block_shift = 2;            ///< e: blocks of 2^e voxels on each axis
  std::array<int, 3> n_blocks{};  ///< n / 2^e, rounded up
  EntryLayout layout;
  std::vector<std::uint32_t> block;  ///< n_blocks, x fastest
  std::vector<std::uint32_t> entry;  ///< one word an entry, two where the layout is wide
  ErrorBound bound;                  ///< asked for
  ErrorBound measured;               ///< the greatest over all voxels; never above bound
  float jump = HUGE_VALF;            ///< Field::jump of the flat field that it was made from

  [[nodiscard]] std::size_t bytes() const {
    return (block.size() + entry.size()) * sizeof(std::uint32_t);
  }
};

/// Compresses `field` so that every voxel meets `bound`, and measures it on all voxels, with the
/// look-up's own arithmetic. block_shift 2 to 4, or 0: the one that takes least memory. Throws
/// Error(bad_argument) for a bound that is negative or NaN, or another block_shift.
[[nodiscard]] CompressedField compress(const Field& field, const ErrorBound& bound,
                                       int block_shift = 0);

/// The flat field that look-ups of `field` see, with the jump of its own distances.
[[nodiscard]] Field expanded(const CompressedField& field);

/// The flat field without its arrays: what stands beside a compressed field in an object.
[[nodiscard]] Field outline(const CompressedField& field);

/// What voxel (i, j, k) of the grid says of the distance.
[[nodiscard]] float voxel_distance(const CompressedField& field, int i, int j, int k);

/// Unit normals of n points, or zero where there is none.
struct NormalColumns {
  std::span<float> x, y, z;
};

/// As nearest_distance() of a flat field, within the bound.
void nearest_distance(const CompressedField& field, const Points& points,
                      std::span<float> distance);

/// The normal of the nearest voxel; zero outside the grid and for NaN points. The field must have
/// content distance_and_normal.
void nearest_normal(const CompressedField& field, const Points& points,
                    const NormalColumns& normal);

/// Both.
void nearest(const CompressedField& field, const Points& points, std::span<float> distance,
             const NormalColumns& normal);

}  // namespace tess::dn
