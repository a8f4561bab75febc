// Points of a surface, evenly over its area.
#pragma once

#include "collide/dn_field/surface.hpp"

namespace tess::dn {

struct SurfacePoint {
  Vec3 at;
  Vec3 normal;  ///< unit; zero on a triangle without area
  std::uint32_t triangle = 0;
};

/// The area of the triangles up to each, that one included.
[[nodiscard]] std::vector<double> area_sums(const Surface& surface);

/// The point of three numbers within [0, 1): the first chooses a triangle by its area, the others a
/// point of it. `sums`: area_sums(surface), not empty.
[[nodiscard]] SurfacePoint point_on(const Surface& surface, const std::vector<double>& sums,
                                    double first, double second, double third);

}  // namespace tess::dn
