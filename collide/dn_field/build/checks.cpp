#include "collide/dn_field/build/checks.hpp"

#include "runtime/base/usable_memory.hpp"
#include "runtime/core/error.hpp"

namespace tess::dn {

void require_buildable(const Grid& grid, double bytes_per_voxel) {
  const auto [nx, ny, nz] = grid.n;
  const std::string grid_text = text("grid of ", nx, " × ", ny, " × ", nz, " voxels");
  if (nx < 1 || ny < 1 || nz < 1)
    fail(ErrorCode::bad_argument, grid_text, "; each axis needs at least one");
  if (!(grid.cell > 0) || !std::isfinite(grid.cell) || !is_finite(grid.origin))
    fail(ErrorCode::bad_argument, "grid with cells of ", grid.cell, " from (", grid.origin.x, ", ",
         grid.origin.y, ", ", grid.origin.z, "); cells must be positive and all of it finite");
  const double wanted = bytes_per_voxel * nx * ny * nz, there = tess::detail::usable_memory();
  if (wanted > there)
    fail(ErrorCode::environment, grid_text, " takes ", wanted / 1e9,
         " GB to build, this process may have ", there / 1e9, "; lower the resolution");
}

void require_thick(const Grid& grid, double thickness) {
  if (!(thickness >= 2 * grid.cell))
    fail(ErrorCode::bad_argument, "thickness ", thickness, " of a field with cells of ", grid.cell,
         "; it must be at least two cells");
}

}  // namespace tess::dn
