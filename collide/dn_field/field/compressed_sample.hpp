// Eight look-ups in one compressed field, in grid coordinates: what sample.hpp does for flat ones.
// Entries are decoded by the operations of EntryDecoder in their order, so that the measured error
// holds here too. Private to the step loop.
#pragma once

#include "collide/dn_field/field/compressed_entry.hpp"
#include "collide/dn_field/field/sample.hpp"

namespace tess::dn {

/// A compressed field as the loops see it.
struct PlaneSampler {
  const std::uint32_t* block = nullptr;
  const std::uint32_t* entry = nullptr;
  bool wide = false;
  int bits = 0;  ///< of each coordinate of a narrow entry's normal
  std::int32_t mask = 0, middle = 0;
  std::uint32_t zero = 0;  ///< of a narrow entry's distance
  float per_middle = 0, step = 0;
  float cell = 1, thickness = 0;
  int e = 2, row = 1, layer = 1;  ///< of blocks
  int n[3] = {0, 0, 0};
};

inline PlaneSampler sampler_of(const CompressedField& field) {
  const EntryDecoder decoder(field.layout);
  return {field.block.data(),
          field.entry.data(),
          field.layout.wide,
          field.layout.wide ? 0 : field.layout.normal_bits,
          static_cast<std::int32_t>(decoder.mask),
          decoder.middle,
          static_cast<std::uint32_t>(decoder.zero),
          decoder.per_middle,
          decoder.step,
          static_cast<float>(field.grid.cell),
          static_cast<float>(field.thickness),
          field.block_shift,
          field.n_blocks[0],
          field.n_blocks[0] * field.n_blocks[1],
          {field.grid.n[0], field.grid.n[1], field.grid.n[2]}};
}

namespace lanes {

using U = std::uint32_t __attribute__((vector_size(4 * width)));

/// Distances at the cells' middles.
inline Stored read_planes(const PlaneSampler& field, I at) {
  if (field.wide) {
    const I low = gather(field.entry, at + at), high = gather(field.entry, at + at + 1);
    return {(F)low, unit(decode(high))};
  }
  const I word = gather(field.entry, at);
  const I cu = (word >> field.bits) & field.mask, cv = word & field.mask;
  const F u = __builtin_convertvector(cu - field.middle, F) * field.per_middle;
  const F v = __builtin_convertvector(cv - field.middle, F) * field.per_middle;
  const F3 n = on_octahedron(u, v);
  const F scale = only(cu != field.mask, 1.0F / sqrt(dot(n, n)));
  const I steps = (I)(((U)word >> (2 * field.bits)) - field.zero);
  return {__builtin_convertvector(steps, F) * field.step, scale * n};
}

/// What the voxels say.
inline Stored planes_at(const PlaneSampler& field, const Voxel& voxel) {
  const I i = voxel.i, j = voxel.j, k = voxel.k;
  const int e = field.e, in_block = (1 << e) - 1;
  const I head = gather(field.block, (k >> e) * field.layer + (j >> e) * field.row + (i >> e));
  const I s = head & 7, in_cell = ((I{} + 1) << s) - 1, t = e - s;
  const I li = i & in_block, lj = j & in_block, lk = k & in_block;
  const I at = (I)((U)head >> 3) + ((((lk >> s) << t) + (lj >> s)) << t) + (li >> s);
  Stored plane = read_planes(field, at);
  const auto off = [&](I of) {
    return 0.5F * field.cell * __builtin_convertvector(2 * (of & in_cell) - in_cell, F);
  };
  const F3& n = plane.normal;
  const F d = plane.distance + (n.x * off(li) + n.y * off(lj) + n.z * off(lk));
  plane.distance = min(max(d, all(-field.thickness)), all(field.thickness));
  return plane;
}

/// The nearest and the tangent look-up. An entry's normal is that of all its voxels, so the tangent
/// one carries its plane on; both need the normal.
template <LookUp Kind, Ask Asked>
  requires(Kind != LookUp::trilinear)
inline Sample sample(const PlaneSampler& field, F3 g) {
  const Voxel voxel = voxel_of(field.n, g);
  const Stored plane = planes_at(field, voxel);
  const Stored stored{plane.distance, only(voxel.in, plane.normal)};
  return answer<Kind, Asked>(field.cell, voxel, stored, g);
}

}  // namespace lanes
}  // namespace tess::dn
