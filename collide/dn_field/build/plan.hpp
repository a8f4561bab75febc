// What is decided before a field is built: its grid, its thickness and its blur, from the greatest
// distance that a particle travels in a step.
#pragma once

#include "collide/dn_field/grid.hpp"

namespace tess::dn {

/// What a field has to cover: the way of a whole step, or, where look-ups are swept along the step
/// and no speed passes through, its own few cells.
enum class Coverage { step, swept };

/// A 3D blur with linear attenuation: weight 1 − r / (radius + 1) for voxels at most radius away.
struct Blur {
  int radius = 0;  ///< 2 to 4 voxels
  int rounds = 0;
};

/// A blur that reaches through `thickness` (section 3.1: radius 2 to 4, several rounds).
[[nodiscard]] Blur choose_blur(const Grid& grid, double thickness);

/// Throws Error(bad_argument) for a radius outside 2 … 4 or no round.
void require_blur(const Blur& blur);

struct FieldPlan {
  Grid grid;
  double thickness = 0;
  Blur blur;
};

/// Resolution from the smallest feature, thickness from speed × step (two cells, where look-ups are
/// swept), blur from both. Throws Error(bad_argument) where more than `max_voxels` would be needed.
[[nodiscard]] FieldPlan choose_plan(const Bounds& box, const Demand& demand, Coverage coverage,
                                    std::size_t max_voxels);

/// Throws Error(bad_argument) where a given thickness is passed in one step and look-ups are not
/// swept.
void require_reach(const Demand& demand, Coverage coverage, double thickness);

}  // namespace tess::dn
