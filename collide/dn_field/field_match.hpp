// Whether a field is that of a surface: what is asked of a field from a file.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/surface.hpp"

namespace tess::dn {

/// The greatest difference, in cells, between a voxel's distance, signs apart, and the exact one
/// to `surface`, among 512 voxels all over the field. That of the same surface is rounding:
/// below 1e-3; that of another one is near one or more. Throws Error(bad_mesh) as validate() does.
[[nodiscard]] double mismatch(const Field& field, const Surface& surface);

}  // namespace tess::dn
