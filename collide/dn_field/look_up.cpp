#include "collide/dn_field/look_up.hpp"

#include "runtime/check.hpp"

namespace tess::dn {

void nearest_distance(const Field& field, const Points& points, std::span<float> distance) {
  const std::size_t count = distance.size();
  TESS_CHECK(points.x.size() == count && points.y.size() == count && points.z.size() == count,
             "expected ",
             count,
             " coordinates on each axis");
  TESS_CHECK(field.grid.size() < (std::size_t{1} << 31U), "voxels are numbered in 32 bits");
  const float* const table = field.distance.data();
  const float* const px = points.x.data();
  const float* const py = points.y.data();
  const float* const pz = points.z.data();
  float* const out = distance.data();
  const auto& g = field.grid;
  const auto per_cell = static_cast<float>(1 / g.cell);
  // Half a voxel is added once here, so that truncation rounds to the nearest centre.
  const float ox = static_cast<float>(0.5 - g.origin.x / g.cell);
  const float oy = static_cast<float>(0.5 - g.origin.y / g.cell);
  const float oz = static_cast<float>(0.5 - g.origin.z / g.cell);
  const auto nx = static_cast<float>(g.n[0]), ny = static_cast<float>(g.n[1]),
             nz = static_cast<float>(g.n[2]);
  const int row = g.n[0], layer = g.n[0] * g.n[1];
  for (std::size_t p = 0; p < count; ++p) {
    const float u = px[p] * per_cell + ox, v = py[p] * per_cell + oy, w = pz[p] * per_cell + oz;
    const bool in = (u >= 0) & (u < nx) & (v >= 0) & (v < ny) & (w >= 0) & (w < nz);
    const int i = static_cast<int>(in ? u : 0.0F), j = static_cast<int>(in ? v : 0.0F),
              k = static_cast<int>(in ? w : 0.0F);
    const float found = table[k * layer + j * row + i];
    out[p] = in ? found : out_of_reach;
  }
}

}  // namespace tess::dn
