#include "collide/dn_field/grid.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int min_resolution = 4, max_resolution = 1024;

}  // namespace

Grid grid_around(const Bounds& box, int n, double margin) {
  if (n < min_resolution || n > max_resolution)
    fail(ErrorCode::bad_argument, "resolution ", n, " of a field; it must be ", min_resolution,
         " to ", max_resolution);
  if (!(margin >= 0) || !std::isfinite(margin))
    fail(ErrorCode::bad_argument, "margin ", margin,
         " of a field; it must be finite and not negative");
  const Vec3 size = box.size();
  const double extent = std::max({size.x, size.y, size.z});
  if (!(extent > 0) || !std::isfinite(extent))
    fail(ErrorCode::bad_mesh, "object of extent ", extent, "; it must be positive and finite");
  const double cell = (extent + 2 * margin) / (n - 1);
  if (extent < 2 * cell)
    fail(ErrorCode::bad_argument, "margin ", margin, " leaves the object of extent ", extent,
         " less than two of ", n, " voxels; raise the resolution or lower speed × step");
  const double half = 0.5 * cell * (n - 1);
  return {box.centre() - Vec3{half, half, half}, cell, {n, n, n}};
}

}  // namespace tess::dn
