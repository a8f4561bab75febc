// Fields for tests of numerics: values at the points of a mesh of the unit cube.
#pragma once

#include "m2m/mesh.hpp"

#include <cmath>
#include <functional>
#include <span>
#include <vector>

namespace tess::test {

using Values = std::vector<double>;

inline Values sampled(std::span<const m2m::Point> points,
                      const std::function<double(const m2m::Point&)>& f) {
  Values values;
  for (const m2m::Point& p : points) values.push_back(f(p));
  return values;
}

inline double smooth(const m2m::Point& p) {
  return std::sin(2 * p[0]) * std::cos(p[1]) * std::exp(p[2]);
}
inline double gaussian(const m2m::Point& p) {
  double squared = 0;
  for (const double x : p) squared += (4 * x - 2) * (4 * x - 2);
  return std::exp(-squared);
}
/// The mesh, each of whose coordinates x becomes scale x + offset.
inline m2m::TetMesh moved_by(m2m::TetMesh mesh, double scale, double offset) {
  for (m2m::Point& p : mesh.points)
    for (double& x : p) x = x * scale + offset;
  return mesh;
}
/// 1 within a ball, 0 outside.
inline double ball(const m2m::Point& p) {
  const double x = p[0] - 0.5, y = p[1] - 0.45, z = p[2] - 0.4;
  return x * x + y * y + z * z < 0.09 ? 1.0 : 0.0;
}

}  // namespace tess::test
