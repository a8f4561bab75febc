// Rays, and where they first meet the shapes of the library.
#pragma once

#include "collide/tetrahedron.hpp"

#include <optional>

namespace tess::collide {

/// The points from + t direction with t >= 0. The direction is not zero, and need not be a unit
/// vector.
struct Ray {
  Point from;
  Point direction;
};

/// The least t at which a ray meets an object; 0 if it begins inside. Whether it meets is decided
/// exactly, so no ray passes between triangles that share an edge or a corner. The relative error
/// of t is below 2^-42. A ray does not hit a triangle in whose plane it lies.
[[nodiscard]] std::optional<double> hit(const Aabb& object, const Ray& ray) noexcept;
[[nodiscard]] std::optional<double> hit(const Triangle& object, const Ray& ray) noexcept;
[[nodiscard]] std::optional<double> hit(const Sphere& object, const Ray& ray) noexcept;
[[nodiscard]] std::optional<double> hit(const Tetrahedron& object, const Ray& ray) noexcept;

}  // namespace tess::collide
