// Points and vectors of rational numbers, for tests that compare with exact values.
#pragma once

#include "collide/box.hpp"

#include <boost/multiprecision/cpp_int.hpp>

namespace tess::collide::testing {

using Rational = boost::multiprecision::cpp_rational;

struct Exact {
  Rational x, y, z;

  const Rational& operator[](std::size_t k) const { return k == 0 ? x : k == 1 ? y : z; }
  friend Exact operator+(const Exact& a, const Exact& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Exact operator-(const Exact& a, const Exact& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Exact operator*(const Rational& s, const Exact& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Rational dot(const Exact& a, const Exact& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Exact cross(const Exact& a, const Exact& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

inline Rational distance2(const Exact& a, const Exact& b) {
  return dot(a - b, a - b);
}

inline Exact exact(const Point& p) {
  return {Rational(p[0]), Rational(p[1]), Rational(p[2])};
}

}  // namespace tess::collide::testing
