// Thin walls of a body. A wall thinner than a voxel's diagonal may contain no voxel's centre: a
// one-sided field lets particles through there, and has no normals by the normals method.
#pragma once

#include "collide/dn_field/bvh.hpp"

namespace tess::dn {

/// A body of which a larger share of the surface is thin has near-zero thickness (section 3.1).
inline constexpr double most_thin = 1.0 / 3;

/// The share of the area that has no inside at `depth` behind it: thin walls, sharp edges, open
/// sheets, and triangles that face inwards. Measured at 1024 places spread evenly, so that smaller
/// parts may be missed. `tree`: of the surface.
[[nodiscard]] double thin_share(const Surface& surface, const Bvh& tree, double depth);

}  // namespace tess::dn
