// The choice of a field's grid, thickness and blur, made before it is built, from the greatest
// distance that a particle moves in a step.
#pragma once

#include "collide/dn_field/grid.hpp"

namespace tess::dn {

/// What the fastest particle and the step require of a field.
struct Demand {
  /// Relative to the surface, in the object's units. 0 where paths are swept: no speed passes
  /// through then, and two cells are enough.
  double max_speed = 0;
  double step = 0;    ///< time step
  double detail = 0;  ///< smallest feature to resolve: at least two voxels across it
};

/// A 3D blur with linear attenuation: weight 1 − r / (radius + 1) for voxels at most radius away.
struct Blur {
  int radius = 0;  ///< 2 to 4 voxels
  int rounds = 0;
};

/// A blur that reaches through `thickness` (section 3.1: radius 2 to 4, several rounds).
[[nodiscard]] Blur choose_blur(const Grid& grid, double thickness);

/// Throws Error(bad_argument) for a radius outside 2 … 4 or less than one round.
void require_blur(const Blur& blur);

struct FieldPlan {
  Grid grid;
  double thickness = 0;
  Blur blur;
};

/// Resolution from the smallest feature, thickness from speed × step plus two cells, blur from
/// both. Throws Error(bad_argument) if more than `max_voxels` would be needed.
[[nodiscard]] FieldPlan choose_plan(const Bounds& box, const Demand& demand,
                                    std::size_t max_voxels);

}  // namespace tess::dn
