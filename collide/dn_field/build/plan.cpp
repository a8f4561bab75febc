#include "collide/dn_field/plan.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int min_radius = 2, max_radius = 4;
constexpr double wanted_rounds = 3;
}  // namespace

Blur choose_blur(const Grid& grid, double thickness) {
  // At most the grid: the thickness may be infinite.
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

FieldPlan choose_plan(const Bounds& box, const Demand& demand, std::size_t max_voxels) {
  const double reach = demand.max_speed * demand.step;
  if (!(reach >= 0) || !std::isfinite(reach))
    fail(ErrorCode::bad_argument, "speed ", demand.max_speed, " × step ", demand.step,
         " must be finite, not negative");
  if (!(demand.detail > 0))
    fail(ErrorCode::bad_argument, "smallest feature ", demand.detail, " must be positive");
  const Vec3 size = box.size();
  const double cell = 0.5 * demand.detail, thickness = reach + 2 * cell;
  const double wanted = std::ceil((std::max({size.x, size.y, size.z}) + 2 * thickness) / cell) + 1;
  if (wanted > 1024 || wanted * wanted * wanted > static_cast<double>(max_voxels))
    fail(ErrorCode::bad_argument, "a field of ", wanted, "³ voxels is needed for speed × step ",
         reach, " and features of ", demand.detail, ", above the limit of ", max_voxels,
         "; shorten the step or coarsen the detail");
  const Grid grid = grid_around(box, std::max(4, static_cast<int>(wanted)), thickness);
  return {grid, thickness, choose_blur(grid, thickness)};
}

}  // namespace tess::dn
