// The exact construction: signed distance by the closest feature of the mesh, sign by the winding
// number, so that meshes with holes and flipped triangles work. The surface may be far denser or
// coarser than the grid.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/surface.hpp"

#include <functional>

namespace tess::dn {

struct ExactOptions {
  Sides sides = Sides::one;
  Content content = Content::distance_and_normal;
  double thickness = HUGE_VAL;  ///< in the object's units; distances are cut off here, which saves
                                ///< most of the time
  std::function<void(double)>
      progress;  ///< called with the fraction done, after every layer of voxels; may be empty
};

/// Builds the field of `surface` on `grid`. Errors of distance: rounding to float. Normals point
/// along the gradient of the distance, and are those of the closest triangle within a thousandth of
/// a cell from the surface. Throws Error(bad_mesh) where validate() does, Error(bad_argument) for a
/// thickness below two cells.
[[nodiscard]] Field build_exact(const Surface& surface,
                                const Grid& grid,
                                const ExactOptions& options = {});

}  // namespace tess::dn
