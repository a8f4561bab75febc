#include "collide/dn_field/build_exact.hpp"

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "collide/dn_field/winding_lines.hpp"
#include "runtime/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double on_surface =
    1e-3;  // of a cell: nearer, the direction to the closest point is rounding

void fill_inside(std::vector<std::uint8_t>& inside, const Bvh& tree, const Grid& grid) {
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        inside[grid.index(i, j, k)] = tree.is_inside(grid.centre(i, j, k)) ? 1 : 0;
}

std::vector<std::uint8_t> inside_of(const Surface& surface, const Bvh& tree, const Grid& grid) {
  const Surface whole = welded(surface);
  if (is_closed(whole)) return inside_by_lines(whole, tree, grid);
  std::vector<std::uint8_t> inside(grid.size());
  fill_inside(inside, tree, grid);
  return inside;
}

}  // namespace

Field build_exact(const Surface& surface, const Grid& grid, const ExactOptions& options) {
  validate(surface);
  if (!(options.thickness >= 2 * grid.cell))
    fail(ErrorCode::bad_argument,
         "thickness ",
         options.thickness,
         " of a field with cells of ",
         grid.cell,
         "; it must be at least two cells");
  const Bvh tree(surface);
  const bool one_sided = options.sides == Sides::one;
  const bool with_normals = options.content == Content::distance_and_normal;
  const auto inside =
      one_sided ? inside_of(surface, tree, grid) : std::vector<std::uint8_t>(grid.size(), 0);

  Field field{grid, Method::exact, options.sides, options.thickness, {}, {}};
  field.distance.resize(grid.size());
  if (with_normals) field.normal.assign(grid.size(), no_normal);
  double furthest = 0;
  for (int k = 0; k < grid.n[2]; ++k) {
    for (int j = 0; j < grid.n[1]; ++j) {
      double bound = options.thickness;  // the next voxel is at most one cell further from the
                                         // surface than this one
      for (int i = 0; i < grid.n[0]; ++i) {
        const Vec3 p = grid.centre(i, j, k);
        const double limit = std::min(options.thickness, bound * (1 + 1e-9));
        const ClosestPoint found = tree.closest(p, limit * limit);
        const bool reached = found.distance2 < HUGE_VAL;
        const double distance = reached ? std::sqrt(found.distance2) : options.thickness;
        const double sign = inside[grid.index(i, j, k)] != 0 ? -1 : 1;
        const auto at = grid.index(i, j, k);
        bound = distance + grid.cell;
        furthest = std::max(furthest, distance);
        field.distance[at] = static_cast<float>(sign * distance);
        if (!with_normals || !reached) continue;
        const bool touching = distance < on_surface * grid.cell;
        field.normal[at] =
            encode_normal(touching ? tree.normal(found.triangle) : sign * (p - found.point));
      }
    }
    if (options.progress) options.progress((k + 1.0) / grid.n[2]);
  }
  field.thickness = std::min(options.thickness, furthest);
  return field;
}

}  // namespace tess::dn
