#include "collide/dn_field/walls.hpp"

#include "runtime/core/hash.hpp"

namespace tess::dn {

double thin_share(const Surface& surface, const Bvh& tree, double depth) {
  constexpr std::size_t n_places = 1024;
  const std::vector<double> sums = area_sums(surface);
  double n_thin = 0;
  for (std::size_t i = 0; i < n_places; ++i) {
    // Stratified: one place in each of as many equal parts of the area.
    const double part = (static_cast<double>(i) + tess::unit(mix(3 * i))) / n_places;
    const SurfacePoint place =
        point_on(surface, sums, part, tess::unit(mix(3 * i + 1)), tess::unit(mix(3 * i + 2)));
    if (!tree.is_inside(place.at - depth * place.normal)) ++n_thin;
  }
  return n_thin / n_places;
}

}  // namespace tess::dn
