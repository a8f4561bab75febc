// A compressed field voxel by voxel: for what asks one place at a time, pictures and audits. The
// look-ups of many points stand in compressed.cpp and compressed_sample.hpp.
#include "collide/dn_field/field/compressed_entry.hpp"

namespace tess::dn {
namespace {

struct VoxelPlane {
  float distance;
  Normal normal;
};

VoxelPlane voxel(const CompressedField& field, const EntryDecoder& decoder, int i, int j, int k) {
  const int e = field.block_shift;
  const int block = ((k >> e) * field.n_blocks[1] + (j >> e)) * field.n_blocks[0] + (i >> e);
  const std::uint32_t head = field.block[static_cast<std::size_t>(block)];
  const int s = static_cast<int>(head & 7U), in_block = (1 << e) - 1, in_cell = (1 << s) - 1,
            t = e - s;
  const std::array<int, 3> local{i & in_block, j & in_block, k & in_block};
  const int cell = ((((local[2] >> s) << t) + (local[1] >> s)) << t) + (local[0] >> s);
  const std::size_t entry = (head >> 3U) + static_cast<std::size_t>(cell);
  const Plane plane = field.layout.wide
                          ? EntryDecoder::wide(field.entry[2 * entry], field.entry[2 * entry + 1])
                          : decoder.narrow(field.entry[entry]);
  const float half = 0.5F * static_cast<float>(field.grid.cell);
  const auto off = [&](std::size_t axis) {
    return half * static_cast<float>(2 * (local[axis] & in_cell) - in_cell);
  };
  return {distance_to(plane, off(0), off(1), off(2), static_cast<float>(field.thickness)),
          plane.normal};
}

}  // namespace

float voxel_distance(const CompressedField& field, int i, int j, int k) {
  return voxel(field, EntryDecoder(field.layout), i, j, k).distance;
}

Field expanded(const CompressedField& field) {
  Field flat = outline(field);
  const EntryDecoder decoder(field.layout);
  const bool has_normals = field.content == Content::distance_and_normal;
  const auto [nx, ny, nz] = field.grid.n;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const VoxelPlane here = voxel(field, decoder, i, j, k);
        flat.distance.push_back(here.distance);
        if (has_normals) flat.normal.push_back(encode_normal(to_vec3(here.normal)));
      }
  flat.jump = greatest_jump(flat);
  return flat;
}

Field outline(const CompressedField& field) {
  return {field.grid, field.method, field.sides, field.thickness, {}, {}, field.jump};
}

}  // namespace tess::dn
