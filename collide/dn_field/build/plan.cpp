#include "collide/dn_field/build/plan.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int min_radius = 2, max_radius = 4;
constexpr double wanted_rounds = 3;
}  // namespace

Blur choose_blur(const Grid& grid, double thickness) {
  // No wider than the grid: an infinite thickness asks for all of it.
  const double cells =
      std::min(thickness / grid.cell, 1.0 * std::max({grid.n[0], grid.n[1], grid.n[2]}));
  const int radius =
      std::clamp(static_cast<int>(std::lround(cells / wanted_rounds)), min_radius, max_radius);
  return {radius, static_cast<int>(std::ceil(cells / radius)) + 1};
}

void require_blur(const Blur& blur) {
  if (blur.radius < min_radius || blur.radius > max_radius)
    fail(ErrorCode::bad_argument, "blur of radius ", blur.radius, " voxels; it must be ",
         min_radius, " to ", max_radius);
  if (blur.rounds < 1)
    fail(ErrorCode::bad_argument, "blur of ", blur.rounds, " rounds; it takes at least one");
}

FieldPlan choose_plan(const Bounds& box, const Demand& demand, Coverage coverage,
                      std::size_t max_voxels) {
  Demand asked = demand;
  if (coverage == Coverage::swept) asked.max_speed = 0;
  const Choice choice = choose(box, asked, max_voxels);
  // The cell came out a little smaller than asked for: two cells are still covered.
  return {choice.grid, choice.thickness, choose_blur(choice.grid, choice.thickness)};
}

void require_reach(const Demand& demand, Coverage coverage, double thickness) {
  if (coverage == Coverage::step) require_covered(demand, thickness);
}

}  // namespace tess::dn
