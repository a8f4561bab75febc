// What a field says at many points at once: structure of arrays in, structure of arrays out,
// branch-free, eight points at a time. Points are in the object's own coordinates. Any thread. The
// step loop does the same for particles without the detour over arrays: see closest.hpp.
#pragma once

#include "collide/dn_field/field.hpp"

#include <span>

namespace tess::dn {

/// How a field is asked, from fast to smooth. Off the medial axis:
/// nearest: the value of the closest voxel; off by up to half a voxel's diagonal.
/// tangent: that value carried on along the voxel's normal; exact for planes, error of order 2.
/// trilinear: interpolated between eight voxels, continuous; exact for planes, error of order 2.
enum class LookUp : std::uint32_t { nearest, tangent, trilinear };

inline constexpr float half_diagonal = 0.8660255F;  ///< of a voxel, in cells

/// How far the step loop keeps particles from a sheet that is met from either side, in cells:
/// closer to it a look-up may read a voxel of the other side. Who crosses a corner has not been in
/// any voxel between.
[[nodiscard]] constexpr float sheet_clearance(LookUp kind) {
  return kind == LookUp::nearest ? 2 * half_diagonal : 1.0F;
}

/// What is left of a field's thickness where particles are stopped: rules reach no further.
[[nodiscard]] inline double covered(double thickness, double cell, Sides sides, LookUp kind) {
  return sides == Sides::two ? thickness - static_cast<double>(sheet_clearance(kind)) * cell
                             : thickness;
}

/// n points; all three spans have one length.
struct Points {
  std::span<const float> x, y, z;
};

/// What is asked for: spans of one per point, or empty ones where it is not. Normals are three or
/// none.
struct Answers {
  std::span<float> distance;
  std::span<float> nx, ny, nz;
};

/// Distance: `out_of_reach` outside the grid and for NaN points. Normals: of unit length, or zero
/// where there is none (outside, on the medial axis, beyond the thickness). The trilinear look-up
/// ends at the outer voxels' centres, the others at their faces. Throws Error(bad_argument) where
/// normals are asked of a field that stores none (the tangent look-up always asks).
void look_up(const Field& field, LookUp kind, const Points& points, const Answers& answers);

/// The nearest look-up's distance alone.
void nearest_distance(const Field& field, const Points& points, std::span<float> distance);

inline constexpr float out_of_reach = 3.0e38F;

}  // namespace tess::dn
