#include "m2m/rows/supermesh/triangles.hpp"

#include "m2m/rows/interpolate/locate.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// The cosine of the angle between normals up to which triangles may overlap.
constexpr double least_cosine = 0.5;
/// A point is kept if these coordinates are positive: its weights in the target triangle, how far
/// it may rise above its plane, and how far it may sink below. Then come weights in the source
/// triangle.
constexpr std::size_t n_limits = 5;
using Spot = simd::Vector<double, 8>;

/// A polygon with at most one and a half times the corners after each cut, even if rounding has made
/// it not convex.
struct Polygon {
  std::array<Spot, 20> corners;
  std::size_t n = 3;

  /// Removes what is not above 0. The point of an edge at 0 does not depend on its direction.
  void cut(std::size_t limit) {
    const Polygon from = *this;
    n = 0;
    for (std::size_t i = 0; i < from.n; ++i) {
      const Spot &a = from.corners[i], &b = from.corners[i + 1 < from.n ? i + 1 : 0];
      const bool keeps_a = a[limit] > 0, keeps_b = b[limit] > 0;
      if (keeps_a) corners[n++] = a;
      if (keeps_a == keeps_b) continue;
      const Spot &in = keeps_a ? a : b, &out = keeps_a ? b : a;
      const double sum = in[limit] - out[limit];
      corners[n] = in[limit] / sum * out + -out[limit] / sum * in;
      corners[n++][limit] = 0;
    }
  }
};

/// By triangles at the first corner. The integral of r s over one of the area A with linear r and s
/// is A / 12 (sum over corners of r s + (sum of r) (sum of s)).
PairMoments moments_of(Polygon& polygon, double area) {
  for (std::size_t i = 0; i < polygon.n; ++i) {
    // Corners of the target have the weight 1 then, however large the source triangle is.
    Spot& p = polygon.corners[i];
    const double sum = p[0] + p[1] + p[2];
    for (std::size_t b = 0; b < 3; ++b) p[b] = sum > 0 ? p[b] / sum : 1.0 / 3;
  }
  PairMoments result;
  const Spot& p = polygon.corners[0];
  for (std::size_t i = 2; i < polygon.n; ++i) {
    const Spot &q = polygon.corners[i - 1], &r = polygon.corners[i];
    const double part =
        area * std::abs((q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]));
    const Spot sum = p + q + r;
    result.volume += part;
    for (std::size_t s = 0; s < 3; ++s)
      for (std::size_t t = 0; t < 3; ++t) {
        const std::size_t a = n_limits + s;
        result.mixed[s][t] +=
            part / 12 * (p[a] * p[t] + q[a] * q[t] + r[a] * r[t] + sum[a] * sum[t]);
      }
  }
  return result;
}

}  // namespace

TrianglePlane::TrianglePlane(const Corners& c) : corners(c), snap(snap_reach(c)) {
  std::array<Point, 2> edges{difference(c[1], c[0]), difference(c[2], c[0])};
  double longest = 0;
  for (const Point& edge : edges)
    for (const double x : edge) longest = std::max(longest, std::abs(x));
  if (longest == 0) return;
  scale = 1 / longest;
  for (Point& edge : edges)
    for (double& x : edge) x *= scale;
  const Point across = cross(edges[0], edges[1]);
  const double square = dot(across, across);
  if (square == 0) return;
  area = std::sqrt(square) / 2 * longest * longest;
  slopes = {cross(edges[1], across), cross(across, edges[0])};
  for (std::size_t k = 0; k < 3; ++k) {
    normal[k] = across[k] / std::sqrt(square);
    for (Point& slope : slopes) slope[k] /= square;
  }
}

void TriangleCutter::add(const TrianglePlane& source, const TrianglePlane& target,
                         std::int32_t number) {
  const double cosine = dot(source.normal, target.normal);
  const double facing = facing_ == Facing::either ? std::abs(cosine)
                        : facing_ == Facing::same ? cosine
                                                  : -cosine;
  if (!(facing >= least_cosine)) return;
  const double reach = tolerance_ + source.snap + target.snap;
  Polygon polygon;
  for (std::size_t a = 0; a < 3; ++a) {
    Point arm = difference(source.corners[a], target.corners[0]);
    const double height = dot(target.normal, arm);
    for (double& x : arm) x *= target.scale;
    const double b = dot(target.slopes[0], arm), c = dot(target.slopes[1], arm);
    polygon.corners[a] = Spot{1 - b - c, b, c, reach - height, reach + height, 0, 0, 0};
    polygon.corners[a][n_limits + a] = 1;
  }
  for (std::size_t limit = 0; limit < n_limits; ++limit)
    if (std::none_of(polygon.corners.begin(), polygon.corners.begin() + 3,
                     [&](const Spot& p) { return p[limit] > 0; }))
      return;
  for (std::size_t limit = 0; limit < n_limits; ++limit) polygon.cut(limit);
  pairs_.emplace_back(number, moments_of(polygon, target.area));
}

}  // namespace tess::m2m
