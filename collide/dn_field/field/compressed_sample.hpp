// Samples of a compressed field, a vector of them at a time, in grid coordinates: the counterpart
// of sample.hpp for flat fields. The compressor decodes its entries here, too, so that the error it
// measures is the one that samples have.
#pragma once

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/field/sample.hpp"

namespace tess::dn {

/// A compressed field as the loops read it.
struct PlaneSampler {
  const std::uint32_t* block = nullptr;
  const std::uint32_t* entry = nullptr;
  EntryLayout layout;
  float cell = 1, cut_off = 0;
  int e = 2, row = 1, layer = 1;  ///< of blocks
  int n[3] = {0, 0, 0};
};

inline PlaneSampler plane_sampler_of(const Field& field) {
  const Planes& planes = *field.planes;
  const auto& [nx, ny, nz] = planes.n_blocks;
  return {planes.block.data(),
          planes.entry.data(),
          planes.layout,
          static_cast<float>(field.grid.cell),
          cut_off(field.thickness),
          planes.block_shift,
          nx,
          nx * ny,
          {field.grid.n[0], field.grid.n[1], field.grid.n[2]}};
}

namespace lanes {

using U = simd::Vector<std::uint32_t, width>;

/// The distances at the cells' middles and the normals.
inline Stored decode(const EntryLayout& layout, I entry) {
  const int bits = layout.normal_bits;
  const std::int32_t mask = layout.mask(), middle = layout.middle();
  const float per_middle = 1 / static_cast<float>(middle);
  const I cu = (entry >> bits) & mask, cv = entry & mask;
  const F u = __builtin_convertvector(cu - middle, F) * per_middle;
  const F v = __builtin_convertvector(cv - middle, F) * per_middle;
  const F3 n = on_octahedron(u, v);
  const F scale = only(cu != mask, 1.0F / sqrt(dot(n, n)));
  const I steps = (I)((U)entry >> (2 * bits)) - layout.zero();
  return {__builtin_convertvector(steps, F) * layout.step, scale * n};
}

/// The distances and normals of voxels. Those at the cut-off have no normal, as in a flat field.
inline Stored planes_at(const PlaneSampler& field, const Voxel& voxel) {
  const I i = voxel.i, j = voxel.j, k = voxel.k;
  const int e = field.e, in_block = (1 << e) - 1;
  const I head = gather(field.block, (k >> e) * field.layer + (j >> e) * field.row + (i >> e));
  const I s = head & 7, in_cell = ((I{} + 1) << s) - 1, t = e - s;
  const I li = i & in_block, lj = j & in_block, lk = k & in_block;
  const I at = (I)((U)head >> 3) + ((((lk >> s) << t) + (lj >> s)) << t) + (li >> s);
  Stored plane = decode(field.layout, gather(field.entry, at));
  // The middle of a cell may lie between voxels: twice the offset is a whole number.
  const auto off = [&](I of) {
    return 0.5F * field.cell * __builtin_convertvector(2 * (of & in_cell) - in_cell, F);
  };
  const F3& n = plane.normal;
  const F d = plane.distance + (n.x * off(li) + n.y * off(lj) + n.z * off(lk));
  plane.distance = min(max(d, all(-field.cut_off)), all(field.cut_off));
  plane.normal = only(abs(d) < field.cut_off, plane.normal);
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
