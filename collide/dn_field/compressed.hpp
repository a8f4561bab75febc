// A field in at most a fifth of the memory: two levels, blocks of 4³ to 16³ voxels, each divided
// into equal cells as coarse as the error bound allows (section 3.2).
//
//     block (i >> e, j >> e, k >> e)  ->  first entry << 3 | s; cells of 2^s voxels, s up to e
//
//     entry                           ->  distance at the cell's middle, normal
//
// An entry is a plane equation: the distance of a voxel is that of its centre from the plane, cut
// off at the thickness. A sample takes the same few steps for every division, without a branch.
// Read-only once made; any thread.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/look_up.hpp"

#include <span>

namespace tess::dn {

/// The largest error of a compressed voxel. Any normal fits a voxel without one.
struct ErrorBound {
  double distance = 0;  ///< in the object's units
  double angle = 0;     ///< radians
};

/// The bits of an entry. Wide: a float and a code of normal_code.hpp. Narrow: two coordinates of
/// `normal_bits` bits on the octahedral map; the rest of 32 bits is the distance in steps.
struct EntryLayout {
  bool wide = false;
  int normal_bits = 0;
  float step = 0;
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

/// The flat field without its arrays, for Object::field beside Object::compressed.
[[nodiscard]] Field outline(const CompressedField& field);

/// The distance of voxel (i, j, k).
[[nodiscard]] float voxel_distance(const CompressedField& field, int i, int j, int k);

/// Samples the field as look_up() of a flat one does, within the bound; nearest or tangent.
void look_up(const CompressedField& field, LookUp kind, const Points& points,
             const Answers& answers);

}  // namespace tess::dn
