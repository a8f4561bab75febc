// The pose and motion of an object: rotation, translation and uniform scale map its own coordinates
// to the world. Shear is refused, because distances would not scale by one number.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <array>

namespace tess::dn {

struct Frame {
  std::array<Vec3, 3> axes{
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< images of the unit vectors; orthonormal
  Vec3 position{};                         ///< of the object's origin
  double scale = 1;                        ///< world units per unit of the object
  Vec3 velocity{};                         ///< of the object's origin
  Vec3 angular_velocity{};                 ///< radians per second, about the object's origin
  double scale_rate = 0;                   ///< change of `scale` per second, about the origin

  [[nodiscard]] bool is_moving() const {
    return !(velocity == Vec3{}) || !(angular_velocity == Vec3{}) || is_growing();
  }
  [[nodiscard]] bool is_growing() const { return scale_rate != 0; }
  [[nodiscard]] bool is_turned() const {
    return !(axes[0] == Vec3{1, 0, 0} && axes[1] == Vec3{0, 1, 0} && axes[2] == Vec3{0, 0, 1});
  }
  [[nodiscard]] Vec3 rotate(Vec3 v) const { return v.x * axes[0] + v.y * axes[1] + v.z * axes[2]; }
  [[nodiscard]] Vec3 to_world(Vec3 p) const { return position + scale * rotate(p); }
  [[nodiscard]] Vec3 to_object(Vec3 p) const {
    const Vec3 q = p - position;
    return (1 / scale) * Vec3{dot(axes[0], q), dot(axes[1], q), dot(axes[2], q)};
  }
  /// Moves, turns and scales the frame over `step` by its velocities. Exact for constant
  /// velocities; axes stay orthonormal. The scale must stay above 0.
  void advance(double step);
};

/// The frame of a 3 × 3 matrix (columns: images of the axes) and a translation. Throws
/// Error(bad_value) for shear, unequal or zero scale, reflection, or entries that are not finite.
[[nodiscard]] Frame frame_from(const std::array<Vec3, 3>& columns, Vec3 translation);

/// The rotation by |v| radians about v.
[[nodiscard]] std::array<Vec3, 3> rotation(Vec3 v);

}  // namespace tess::dn
