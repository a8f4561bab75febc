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

/// Within the plane of a triangle: on which side of each edge (from a, b and c) the nearest point
/// to `p` is; 1 is inside. All are 0 if and only if the triangle is degenerate.
[[nodiscard]] inline std::array<int, 3> edge_sides(const std::array<Point, 3>& corners,
                                                   const Point& p) noexcept {
  const auto normal = [&](auto number) {
    return cross(way(number, corners[0], corners[1]), way(number, corners[0], corners[2]));
  };
  const auto over_edge = [&](auto number, std::size_t i) {
    const Point &from = corners[i], &to = corners[(i + 1) % 3];
    return cross(way(number, from, to), way(number, from, p));
  };
  const auto rounded = [](double x) noexcept { return RoundedNumber{x, 0}; };
  const auto rounded_normal = normal(rounded);
  std::array<int, 3> sides{};
  for (std::size_t i = 0; i < 3; ++i) {
    const RoundedNumber side = dot(rounded_normal, over_edge(rounded, i));
    if (side.is_within(1)) {
      sides[i] = side.value > 0 ? 1 : -1;
      continue;
    }
    const auto exact = [](double x) noexcept { return ExactNumber(x); };
    sides[i] = dot(normal(exact), over_edge(exact, i)).sign();
  }
  return sides;
}

/// Whether the nearest point of a triangle is on its face, by edge_sides().
[[nodiscard]] inline bool is_over_face(const std::array<int, 3>& sides) noexcept {
  const bool has_face = sides[0] != 0 || sides[1] != 0 || sides[2] != 0;
  return has_face && sides[0] >= 0 && sides[1] >= 0 && sides[2] >= 0;
}

/// Whether it may be on an edge if it is not on the face: beyond the edge, or the triangle is
/// degenerate.
[[nodiscard]] inline bool may_be_on_edge(const std::array<int, 3>& sides, std::size_t i) noexcept {
  return sides[i] < 0 || (sides[0] == 0 && sides[1] == 0 && sides[2] == 0);
}

}  // namespace tess::collide::shapes
