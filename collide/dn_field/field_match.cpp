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
  const auto nx = static_cast<std::size_t>(field.grid.n[0]),
             ny = static_cast<std::size_t>(field.grid.n[1]);
  double worst = 0;
  for (std::size_t i = 0; i < n_voxels; ++i) {
    const std::size_t at = mix(i) % size;  // every so many would all stand in one plane
    const Vec3 p = field.grid.centre(
        static_cast<int>(at % nx), static_cast<int>(at / nx % ny), static_cast<int>(at / nx / ny));
    const double exact = std::min(std::sqrt(tree.closest(p).distance2), field.thickness);
    worst = std::max(worst, std::abs(std::abs(static_cast<double>(field.distance[at])) - exact));
  }
  return worst / field.grid.cell;
}

}  // namespace tess::dn
