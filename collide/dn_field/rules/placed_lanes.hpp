// What points see of an object that stands somewhere: grid coordinates, normals, velocities.
// Private to the step loop.
#pragma once

#include "collide/dn_field/rules/closest.hpp"

namespace tess::dn::lanes {

/// m v, row by row.
[[gnu::always_inline]] inline F3 times(const float (&m)[3][3], F3 v) {
  const auto row = [&](int i) { return v.x * m[i][0] + v.y * m[i][1] + v.z * m[i][2]; };
  return {row(0), row(1), row(2)};
}

/// A vector of the world in grid coordinates.
[[gnu::always_inline]] inline F3 turned_to_grid(const Placed& object, F3 v) {
  return times(object.to_grid, v);
}

/// Grid coordinates of the world's points `object.centre` + q.
[[gnu::always_inline]] inline F3 to_grid(const Placed& object, F3 q) {
  const F3 g = turned_to_grid(object, q);
  return {g.x + object.middle[0], g.y + object.middle[1], g.z + object.middle[2]};
}

/// A vector of the object in the world, at scale 1.
[[gnu::always_inline]] inline F3 to_world(const Placed& object, F3 n) {
  return times(object.to_world, n);
}

/// What a look-up found, in world units; out_of_reach outside of the field.
inline F distance_in_world(const Placed& object, const Sample& found) {
  return found.in ? found.distance * object.scale - object.padding : all(out_of_reach);
}
/// Distance to the box of the grid along its furthest axis: no more than the true one, also after
/// the rounding of coordinates far away.
inline F outside_by(const Placed& object, F3 g) {
  const auto beyond = [](F at, int n) { return max(-at, at - static_cast<float>(n - 1)); };
  return 0.999999F * object.cell *
         max(max(beyond(g.x, object.field.n[0]), beyond(g.y, object.field.n[1])),
             max(beyond(g.z, object.field.n[2]), F{}));
}

inline F free_in_world(const Placed& object, const Sample& found, F3 g) {
  return found.in ? found.free * object.scale - object.error : outside_by(object, g);
}

inline D3 cross(Vec3 a, D3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Velocity of the object at points `arm` from its origin, growth apart.
inline D3 stiff_velocity(const Frame& f, D3 arm) {
  return all(f.velocity) + cross(f.angular_velocity, arm);
}

}  // namespace tess::dn::lanes
