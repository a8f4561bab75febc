#include "apps/particles/blurred_field.hpp"

#include "collide/dn_field/build_blurred.hpp"

namespace particles {

tess::dn::Field blurred_field(const tess::dn::Surface& surface,
                              const tess::dn::Grid& grid,
                              tess::dn::Method method,
                              tess::dn::Sides sides,
                              double thickness) {
  tess::dn::BlurredOptions options;
  options.method = method;
  options.sides = sides;
  options.thickness = thickness;
  return build_blurred(surface, grid, options);
}

}  // namespace particles
