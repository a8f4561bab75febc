#include "collide/dn_field/compressed.hpp"

#include "collide/dn_field/field/compressed_sample.hpp"

namespace tess::dn {
namespace {

lanes::Stored voxel(const PlaneSampler& sampler, int i, int j, int k) {
  const lanes::I zero{};
  return lanes::planes_at(sampler, {~zero, zero + i, zero + j, zero + k});
}

}  // namespace

float voxel_distance(const Field& field, int i, int j, int k) {
  return field.planes != nullptr ? voxel(plane_sampler_of(field), i, j, k).distance[0]
                                 : field.distance[field.grid.index(i, j, k)];
}

Field expanded(const Field& field) {
  Field flat = field;
  flat.planes = nullptr;
  const PlaneSampler sampler = plane_sampler_of(field);
  const auto [nx, ny, nz] = field.grid.n;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const lanes::Stored here = voxel(sampler, i, j, k);
        flat.distance.push_back(here.distance[0]);
        flat.normal.push_back(encode_normal(lanes::lane(here.normal, 0)));
      }
  flat.jump = greatest_jump(flat);
  return flat;
}

}  // namespace tess::dn
