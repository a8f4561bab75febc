// Surfaces with known distances: built-in shapes of scenes, and oracles of tests.
#pragma once

#include "collide/dn_field/surface.hpp"

namespace tess::dn {

/// The box |x| <= half.x, … : 12 triangles.
[[nodiscard]] Surface make_box(Vec3 half);

/// A sphere around the origin, `rings` × 2 `rings` quads split in two, vertices on the sphere.
[[nodiscard]] Surface make_sphere(double radius, int rings);

/// A torus around the z axis, `n` × `n` quads split in two, vertices on the torus.
[[nodiscard]] Surface make_torus(double major_radius, double minor_radius, int n);

/// One open square |x|, |y| <= half in the plane z = 0, normal +z, of 2 n² triangles.
[[nodiscard]] Surface make_plate(double half, int n);

}  // namespace tess::dn
