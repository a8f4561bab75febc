// The blur of the paper's two methods.
#pragma once

#include "collide/dn_field/grid.hpp"

namespace tess::dn {

/// A 3D blur with linear attenuation: weight 1 − r / (radius + 1) for voxels at most radius away.
struct Blur {
  int radius = 0;  ///< 2 to 4 voxels
  int rounds = 0;
};

/// A blur that reaches through `thickness` (section 3.1: radius 2 to 4, several rounds).
[[nodiscard]] Blur choose_blur(const Grid& grid, double thickness);

/// Throws Error(bad_argument) for a radius outside 2 … 4 or less than one round.
void require_blur(const Blur& blur);

}  // namespace tess::dn
