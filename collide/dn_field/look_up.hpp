// Samples of a field, flat or compressed, at many points: structure of arrays in, structure of
// arrays out, branch-free, a vector of points at a time. Points are in the object's own
// coordinates. Any thread. The step loop samples fields in its own loops.
#pragma once

#include "collide/dn_field/field.hpp"

#include <span>

namespace tess::dn {

/// How a field is sampled, from fast to smooth. Off the medial axis:
/// nearest: the value of the nearest voxel; error of up to half a voxel's diagonal.
/// tangent: that value continued along the voxel's normal; exact for planes, error of order 2.
/// trilinear: interpolated between eight voxels, continuous; exact for planes, error of order 2.
enum class LookUp : std::uint32_t { nearest, tangent, trilinear };
inline constexpr const char* look_up_names[] = {"nearest", "tangent", "trilinear"};
[[nodiscard]] constexpr const char* name_of(LookUp kind) {
  return look_up_names[static_cast<std::size_t>(kind)];
}

inline constexpr float half_diagonal = 0.8660255F;  ///< of a voxel, in cells

/// The distance in cells that the step loop keeps between particles and an open surface: closer to
/// it a sample may read a voxel of the other side.
[[nodiscard]] constexpr float open_surface_clearance(LookUp kind) {
  return kind == LookUp::nearest ? 2 * half_diagonal : 1.0F;
}

/// The part of a field's thickness that rules may reach into: less the clearance.
[[nodiscard]] inline double covered(double thickness, double cell, Sides sides, LookUp kind) {
  return sides == Sides::two ? thickness - static_cast<double>(open_surface_clearance(kind)) * cell
                             : thickness;
}

/// n points; all three spans have one length.
struct Points {
  std::span<const float> x, y, z;
};

/// Room for the results, one per point; a span is empty if its result is not asked for. Either all
/// three components of the normal are asked for or none.
struct Answers {
  std::span<float> distance{};
  std::span<float> nx{}, ny{}, nz{};
};

/// Distances are `out_of_reach` outside the grid and for NaN points. Normals have unit length, or
/// are zero where there is none: outside, on the medial axis, beyond the thickness. The trilinear
/// look-up ends at the outer voxels' centres, the others at their faces. Throws Error(bad_argument)
/// if normals are asked of a field that stores none (the tangent look-up always reads them), for a
/// trilinear look-up of a compressed field, and for a field that was not built.
void look_up(const Field& field, LookUp kind, const Points& points, const Answers& answers);

inline constexpr float out_of_reach = 3.0e38F;

}  // namespace tess::dn
