// Samples of a compressed field, a vector of them at a time, in grid coordinates: the counterpart
// of sample.hpp for flat fields. The compressor decodes its entries here, too, so that the error it
// measures is the one that samples have.
#pragma once

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/field/sample.hpp"

namespace tess::dn {

/// What decoding needs of an EntryLayout.
struct EntryDecoder {
  EntryDecoder() = default;
  explicit EntryDecoder(const EntryLayout& layout) : wide(layout.wide), step(layout.step) {
    if (wide) return;
    bits = layout.normal_bits;
    mask = (1 << bits) - 1;
    middle = mask >> 1;
    zero = 1 << (31 - 2 * bits);
    per_middle = middle > 0 ? 1 / static_cast<float>(middle) : 0;
  }

  bool wide = false;
  // Narrow: 32 bits, the distance in steps above two coordinates of 0 … 2 middle on the octahedral
  // map. `mask` in the first coordinate means no normal.
  int bits = 0;
  std::int32_t mask = 0, middle = 0, zero = 0;
  float per_middle = 0, step = 0;
};

/// A compressed field as the loops read it.
struct PlaneSampler {
  const std::uint32_t* block = nullptr;
  const std::uint32_t* entry = nullptr;
  EntryDecoder decoder;
  float cell = 1, thickness = 0;
  int e = 2, row = 1, layer = 1;  ///< of blocks
  int n[3] = {0, 0, 0};
};

inline PlaneSampler plane_sampler_of(const Field& field) {
  const Planes& planes = *field.planes;
  const auto& [nx, ny, nz] = planes.n_blocks;
  return {planes.block.data(),
          planes.entry.data(),
          EntryDecoder(planes.layout),
          static_cast<float>(field.grid.cell),
          static_cast<float>(field.thickness),
          planes.block_shift,
          nx,
          nx * ny,
          {field.grid.n[0], field.grid.n[1], field.grid.n[2]}};
}

namespace lanes {

using U = std::uint32_t __attribute__((vector_size(4 * width)));

/// The distances at the cells' middles and the normals. `high`: of wide entries only.
inline Stored decode(const EntryDecoder& decoder, I low, I high) {
  if (decoder.wide) return {(F)low, unit(decode(high))};
  const I cu = (low >> decoder.bits) & decoder.mask, cv = low & decoder.mask;
  const F u = __builtin_convertvector(cu - decoder.middle, F) * decoder.per_middle;
  const F v = __builtin_convertvector(cv - decoder.middle, F) * decoder.per_middle;
  const F3 n = on_octahedron(u, v);
  const F scale = only(cu != decoder.mask, 1.0F / sqrt(dot(n, n)));
  const I steps = (I)((U)low >> (2 * decoder.bits)) - decoder.zero;
  return {__builtin_convertvector(steps, F) * decoder.step, scale * n};
}

inline Stored read_planes(const PlaneSampler& field, I at) {
  const auto& decoder = field.decoder;
  if (!decoder.wide) return decode(decoder, gather(field.entry, at), I{});
  return decode(decoder, gather(field.entry, at + at), gather(field.entry, at + at + 1));
}

/// The distances and normals of voxels.
inline Stored planes_at(const PlaneSampler& field, const Voxel& voxel) {
  const I i = voxel.i, j = voxel.j, k = voxel.k;
  const int e = field.e, in_block = (1 << e) - 1;
  const I head = gather(field.block, (k >> e) * field.layer + (j >> e) * field.row + (i >> e));
  const I s = head & 7, in_cell = ((I{} + 1) << s) - 1, t = e - s;
  const I li = i & in_block, lj = j & in_block, lk = k & in_block;
  const I at = (I)((U)head >> 3) + ((((lk >> s) << t) + (lj >> s)) << t) + (li >> s);
  Stored plane = read_planes(field, at);
  // The middle of a cell may lie between voxels: twice the offset is a whole number.
  const auto off = [&](I of) {
    return 0.5F * field.cell * __builtin_convertvector(2 * (of & in_cell) - in_cell, F);
  };
  const F3& n = plane.normal;
  const F d = plane.distance + (n.x * off(li) + n.y * off(lj) + n.z * off(lk));
  plane.distance = min(max(d, all(-field.thickness)), all(field.thickness));
  return plane;
}

/// The nearest and the tangent look-up. The tangent continues the plane of the voxel's entry. Both
/// decode the normal.
template <LookUp Kind, Ask>
  requires(Kind != LookUp::trilinear)
inline Sample sample(const PlaneSampler& field, F3 g) {
  const Voxel voxel = voxel_of(field.n, g);
  const Stored plane = planes_at(field, voxel);
  const Stored stored{plane.distance, only(voxel.in, plane.normal)};
  return answer<Kind>(field.cell, voxel, stored, g);
}

}  // namespace lanes
}  // namespace tess::dn
