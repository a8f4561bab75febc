// How thick a body is behind its surface. A wall thinner than a voxel's diagonal may hold no voxel
// that knows of it: a one-sided field lets particles through there.
#pragma once

#include "collide/dn_field/bvh.hpp"

#include <vector>

namespace tess::dn {

/// Thicknesses at 1024 places spread evenly over the surface's area, the least first: how far
/// along the inward normal the body ends at a face that looks the opposite way, to 30°. 0 where
/// nothing is inside behind the place, as of a flat open sheet; HUGE_VAL where the body ends at a
/// slant (an edge is no wall). `tree`: of the surface. Empty for a surface without area.
[[nodiscard]] std::vector<double> wall_thicknesses(const Surface& surface, const Bvh& tree);

/// The share of places that are thinner.
[[nodiscard]] double share_thinner(const std::vector<double>& thicknesses, double length);

}  // namespace tess::dn
