// A capsule: all points within a radius of a segment. It bounds a long thin object far more closely
// than a box whose axes are not those of the object. A search of pairs uses the capsules of thin
// objects to reject pairs whose boxes overlap but whose objects are far apart, and to divide long
// objects into pieces (pairs.hpp).
#pragma once

#include "collide/box.hpp"

#include <limits>

namespace tess::collide {

/// If a number of it is NaN or infinite, or the radius negative, nothing is known of the object: it
/// is searched by its box.
struct Capsule {
  Point from;
  Point to;
  double radius;

  friend bool operator==(const Capsule&, const Capsule&) = default;
};

/// The capsule of an object of which no capsule is known.
inline constexpr Capsule unknown_capsule{{}, {}, std::numeric_limits<double>::infinity()};

/// The capsule, or unknown_capsule if nothing is known of the object.
[[nodiscard]] Capsule checked(const Capsule& capsule) noexcept;

/// A capsule that contains the convex hull of one or more points, whatever is rounded: around the
/// segment between the two points that are farthest apart. The radius is at most sqrt(3) times the
/// least for that segment, and some roundings.
[[nodiscard]] Capsule capsule_around(std::span<const Point> points) noexcept;

}  // namespace tess::collide
