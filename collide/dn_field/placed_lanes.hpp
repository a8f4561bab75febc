// What eight points see of an object that stands somewhere: grid coordinates, normals, velocities.
// Private to the step loop.
#pragma once

#include "collide/dn_field/closest.hpp"

namespace tess::dn::lanes {

inline D3 all(Vec3 v) {
  return {all(v.x), all(v.y), all(v.z)};
}

/// Grid coordinates of the world's points `object.centre` + q.
[[gnu::always_inline]] inline F3 to_grid(const Placed& object, F3 q) {
  const auto& m = object.to_grid;
  const auto row = [&](int i) {
    return q.x * m[i][0] + q.y * m[i][1] + q.z * m[i][2] + object.middle[i];
  };
  return {row(0), row(1), row(2)};
}

/// A vector of the world in grid coordinates.
[[gnu::always_inline]] inline F3 turned_to_grid(const Placed& object, F3 v) {
  const auto& m = object.to_grid;
  const auto row = [&](int i) { return v.x * m[i][0] + v.y * m[i][1] + v.z * m[i][2]; };
  return {row(0), row(1), row(2)};
}

/// A vector of the object in the world, at scale 1.
[[gnu::always_inline]] inline F3 to_world(const Placed& object, F3 n) {
  const auto& r = object.to_world;
  const auto row = [&](int i) { return n.x * r[i][0] + n.y * r[i][1] + n.z * r[i][2]; };
  return {row(0), row(1), row(2)};
}

/// Distance to the box of the grid along its furthest axis: no more than the true one.
inline F outside_by(const Placed& object, F3 g) {
  const auto beyond = [](F at, int n) { return max(-at, at - static_cast<float>(n - 1)); };
  return object.cell * max(max(beyond(g.x, object.field.n[0]), beyond(g.y, object.field.n[1])),
                           max(beyond(g.z, object.field.n[2]), F{}));
}

/// Velocity of the object at points `arm` from its origin, growth apart.
inline D3 stiff_velocity(const Frame& f, D3 arm) {
  const Vec3 w = f.angular_velocity;
  return {f.velocity.x + (w.y * arm.z - w.z * arm.y),
          f.velocity.y + (w.z * arm.x - w.x * arm.z),
          f.velocity.z + (w.x * arm.y - w.y * arm.x)};
}

}  // namespace tess::dn::lanes
