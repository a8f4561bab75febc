#include "collide/dn_field/field_match.hpp"

#include "collide/dn_field/bvh.hpp"
#include "runtime/base/mix.hpp"

#include <algorithm>

namespace tess::dn {

double mismatch(const Field& field, const Surface& surface) {
  constexpr std::size_t n_voxels = 512;
  validate(surface);
  const Bvh tree(surface);
  const std::size_t size = field.grid.size();
  double worst = 0;
  for (std::size_t sample = 0; sample < n_voxels; ++sample) {
    const std::size_t at = mix(sample) % size;  // every so many would all stand in one plane
    const auto [i, j, k] = field.grid.voxel(at);
    const Vec3 p = field.grid.centre(i, j, k);
    const double exact = std::min(std::sqrt(tree.closest(p).distance2), field.thickness);
    const double off = std::abs(std::abs(static_cast<double>(field.distance[at])) - exact);
    if (!(off <= worst)) worst = off;  // NaN, too
  }
  return worst / field.grid.cell;
}

}  // namespace tess::dn
