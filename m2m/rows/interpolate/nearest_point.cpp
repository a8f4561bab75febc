#include "m2m/rows/interpolate/nearest_point.hpp"

#include "m2m/rows/interpolate/orientation.hpp"

#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

/// The nearest so far; distances are squared, and in the scaled units.
struct Closest {
  Weights weights{};
  double squared = std::numeric_limits<double>::infinity();

  void offer(double candidate, const Weights& at) {
    if (candidate < squared) *this = {at, candidate};
  }
};

}  // namespace

NearestPoint nearest_point(const Point& p, const std::array<Point, 4>& corners) {
  // Relative to p, and scaled by a power of two, so that no product leaves the range of double.
  std::array<Point, 4> c;
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    c[i] = difference(corners[i], p);
    for (const double x : c[i]) largest = std::max(largest, std::abs(x));
  }
  int exponent = 0;
  (void)std::frexp(largest, &exponent);
  for (Point& corner : c)
    for (double& x : corner) x = std::ldexp(x, -exponent);

  Closest best;
  for (std::size_t i = 0; i < 4; ++i) {
    Weights at{};
    at[i] = 1;
    best.offer(dot(c[i], c[i]), at);
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const Point edge = difference(c[j], c[i]);
      const double along = -dot(c[i], edge), length = dot(edge, edge);
      if (!(along > 0 && along < length)) continue;
      const double t = along / length;
      Weights at{};
      at[i] = 1 - t;
      at[j] = t;
      const Point q{c[i][0] + t * edge[0], c[i][1] + t * edge[1], c[i][2] + t * edge[2]};
      best.offer(dot(q, q), at);
    }
  for (const auto& [i, j, k] : faces_of_tet) {
    const Point normal = cross(difference(c[j], c[i]), difference(c[k], c[i]));
    // The areas, times 2 |normal|, of the triangles that the foot of p forms with the edges.
    const double a = dot(normal, cross(c[j], c[k])), b = dot(normal, cross(c[k], c[i])),
                 d = dot(normal, cross(c[i], c[j]));
    const double sum = a + b + d, squared = dot(normal, normal);
    if (!(a >= 0 && b >= 0 && d >= 0 && sum > 0 && squared > 0)) continue;
    Weights at{};
    at[i] = a / sum;
    at[j] = b / sum;
    at[k] = d / sum;
    const double height = dot(c[i], normal);
    best.offer(height * height / squared, at);
  }
  return {best.weights, std::ldexp(std::sqrt(best.squared), exponent)};
}

}  // namespace tess::m2m
