#include "collide/dn_field/grid.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int min_resolution = 4, max_resolution = 1024;

double longest(Vec3 size) {
  return std::max({size.x, size.y, size.z});
}
}  // namespace

Grid grid_around(const Bounds& box, int n, double margin) {
  if (n < min_resolution || n > max_resolution)
    fail(ErrorCode::bad_argument, "resolution ", n, " of a field; it must be ", min_resolution,
         " to ", max_resolution);
  if (!(margin >= 0) || !std::isfinite(margin))
    fail(ErrorCode::bad_argument, "margin ", margin,
         " of a field; it must be finite and not negative");
  const double extent = longest(box.size());
  if (!(extent > 0) || !std::isfinite(extent))
    fail(ErrorCode::bad_mesh, "object of extent ", extent, "; it must be positive and finite");
  const double cell = (extent + 2 * margin) / (n - 1);
  if (extent < 2 * cell)
    fail(ErrorCode::bad_argument, "margin ", margin, " leaves the object of extent ", extent,
         " less than two of ", n, " voxels; raise the resolution or lower speed × step");
  const double half = 0.5 * cell * (n - 1);
  return {box.centre() - Vec3{half, half, half}, cell, {n, n, n}};
}

Choice choose(const Bounds& box, const Demand& demand, std::size_t max_voxels) {
  const double reach = demand.max_speed * demand.step, extent = longest(box.size());
  if (!(reach >= 0) || !std::isfinite(reach))
    fail(ErrorCode::bad_argument, "speed ", demand.max_speed, " × step ", demand.step,
         " must be finite, not negative");
  if (!(demand.detail > 0))
    fail(ErrorCode::bad_argument, "smallest feature ", demand.detail, " must be positive");
  const double cell = 0.5 * demand.detail;
  const double thickness = reach + 2 * cell;
  const double wanted = std::ceil((extent + 2 * thickness) / cell) + 1;
  if (wanted > max_resolution || wanted * wanted * wanted > static_cast<double>(max_voxels))
    fail(ErrorCode::bad_argument, "a field of ", wanted, "³ voxels is needed for speed × step ",
         reach, " and features of ", demand.detail, ", above the limit of ", max_voxels,
         "; shorten the step or coarsen the detail");
  return {grid_around(box, std::max(min_resolution, static_cast<int>(wanted)), thickness),
          thickness};
}

void require_covered(const Demand& demand, double thickness) {
  const double reach = demand.max_speed * demand.step;
  if (reach > thickness)
    fail(ErrorCode::bad_argument, "speed ", demand.max_speed, " × step ", demand.step, " = ", reach,
         " passes the field of thickness ", thickness,
         " in one step; use swept look-up, a thicker field or a shorter step");
}

}  // namespace tess::dn
