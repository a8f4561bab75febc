// Vectors of numbers of any kind, for formulas of sign_of() and ratio().
#pragma once

#include "collide/box.hpp"
#include "collide/shapes/sign_of.hpp"

namespace tess::collide::shapes {

template <class Number>
struct Vector {
  Number x, y, z;

  friend Vector operator-(const Vector& a, const Vector& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Number dot(const Vector& a, const Vector& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  friend Vector cross(const Vector& a, const Vector& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

/// The numbers of a point.
template <class MakeNumber>
[[nodiscard]] auto vector(const MakeNumber& number, const Point& p) noexcept {
  return Vector<decltype(number(0))>{number(p[0]), number(p[1]), number(p[2])};
}

/// to - from.
template <class MakeNumber>
[[nodiscard]] auto way(const MakeNumber& number, const Point& from, const Point& to) noexcept {
  return vector(number, to) - vector(number, from);
}

/// Whether the nearest point of the plane through a, b, c, which has a normal, is in the triangle.
[[nodiscard]] inline bool projects_onto(const Point& a, const Point& b, const Point& c,
                                        const Point& p) noexcept {
  const auto is_inside_edge = [&](const Point& from, const Point& to) {
    return sign_of([&](auto number) {
             const auto normal = cross(way(number, a, b), way(number, a, c));
             return dot(normal, cross(way(number, from, to), way(number, from, p)));
           }) >= 0;
  };
  return is_inside_edge(a, b) && is_inside_edge(b, c) && is_inside_edge(c, a);
}

}  // namespace tess::collide::shapes
