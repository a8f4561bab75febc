// What a field says at many points at once: structure-of-arrays in, structure-of-arrays out,
// branch-free. Points are in the object's own coordinates. Any thread. g++ 12 does not yet turn the
// loop into vector gathers: scalar speed.
#pragma once

#include "collide/dn_field/field.hpp"

#include <span>

namespace tess::dn {

/// n points; all three spans have one length.
struct Points {
  std::span<const float> x, y, z;
};

/// Distance in the voxel whose centre is nearest; `out_of_reach` outside the grid and for NaN
/// points. Off by up to half a voxel's diagonal (|gradient| <= 1). distance: one per point.
void nearest_distance(const Field& field, const Points& points, std::span<float> distance);

inline constexpr float out_of_reach = 3.0e38F;

}  // namespace tess::dn
