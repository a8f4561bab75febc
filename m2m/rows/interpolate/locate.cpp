#include "m2m/rows/interpolate/locate.hpp"

#include "m2m/rows/interpolate/nearest_point.hpp"
#include "m2m/rows/interpolate/orientation.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// Bounds the rounding error of a volume relative to the product of the reaches along x, y and z: a
/// volume is a sum of six products, and none of them exceeds the product of the reaches.
constexpr double volume_bound = 6 * orientation_bound;
/// If the sum of the volumes exceeds this multiple of the product of the reaches, the rounding
/// error of each weight is below 1e-12.
constexpr double flat_limit = 4 * volume_bound * 1e12;

/// A point that snaps has weights of its own down to minus this. They are those of the nearest point
/// of a tetrahedron that is nearly flat, whose heights are not much larger than the distance.
constexpr double most_extrapolation = 1e-6;

double largest_coordinate(const Point& p) {
  return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
}

double longest_edge(const std::array<Point, 4>& c) {
  double squared = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const Point edge = difference(c[i], c[j]);
      squared = std::max(squared, dot(edge, edge));
    }
  }
  return std::sqrt(squared);
}

double twice_area(const Point& a, const Point& b, const Point& c) {
  const Point normal = cross(difference(b, a), difference(c, a));
  return std::hypot(normal[0], normal[1], normal[2]);
}

/// True if a point outside snaps: it must be near to the plane of every face that it is outside of,
/// and lie in the padded box. (At a sharp edge both planes are near even far from the tetrahedron.)
bool snaps(const Point& p, const std::array<Point, 4>& corners, const Weights& volume) {
  // The sum of the volumes may be their rounding errors.
  const double total = orientation(corners[0], corners[faces_of_tet[0][0]],
                                   corners[faces_of_tet[0][1]], corners[faces_of_tet[0][2]]);
  if (total == 0) return false;
  const double reach = snap_reach(corners);
  for (std::size_t i = 0; i < 4; ++i) {
    if (volume[i] == 0 || (volume[i] < 0) == (total < 0)) continue;
    const double area = twice_area(corners[faces_of_tet[i][0]], corners[faces_of_tet[i][1]],
                                   corners[faces_of_tet[i][2]]);
    if (!(std::abs(volume[i]) <= reach * area)) return false;
  }
  return overlap(search_box(corners), collide::box_of(p), collide::Touching::counts);
}

}  // namespace

double snap_reach(const std::array<Point, 4>& corners) {
  double largest = 0;
  for (const Point& p : corners) largest = std::max(largest, largest_coordinate(p));
  return snap_edges * longest_edge(corners) + snap_ulps * largest;
}

std::optional<Location> locate(const Point& p, const std::array<Point, 4>& corners) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (p == corners[i]) {
      Location vertex{{}, 0, Status::boundary, Place::corner};
      vertex.weights[i] = 1;
      return vertex;
    }
  }
  Weights volume;
  double total = 0;
  const auto volumes = [&](auto&& orient) {
    for (std::size_t i = 0; i < 4; ++i) {
      volume[i] = orient(p, corners[faces_of_tet[i][0]], corners[faces_of_tet[i][1]],
                         corners[faces_of_tet[i][2]]);
    }
    total = (volume[0] + volume[1]) + (volume[2] + volume[3]);
  };
  volumes(orientation);
  Point reach{};
  for (const Point& corner : corners) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      reach[axis] = std::max(reach[axis], std::abs(corner[axis] - p[axis]));
  }
  if (!(std::abs(total) > flat_limit * (reach[0] * reach[1] * reach[2])))
    volumes(orientation_exact);
  const auto [low, high] = std::minmax_element(volume.begin(), volume.end());
  Location location{};
  for (std::size_t i = 0; i < 4; ++i) location.weights[i] = volume[i] / total;
  if (*low >= 0 || *high <= 0) {
    if (total == 0) return std::nullopt;
    location.status = *low == 0 || *high == 0 ? Status::boundary : Status::inside;
    return location;
  }
  if (!snaps(p, corners, volume)) return std::nullopt;
  const NearestPoint nearest = nearest_point(p, corners);
  location.distance = nearest.distance;
  location.status = Status::snapped;
  const double least = *std::min_element(location.weights.begin(), location.weights.end());
  if (!(least >= -most_extrapolation)) location.weights = nearest.weights;
  return location;
}

Aabb search_box(const std::array<Point, 4>& corners) {
  Aabb box = collide::box_around(corners);
  const double pad = 2 * snap_reach(corners);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] -= pad;
    box.hi[axis] += pad;
  }
  return box;
}

namespace {

/// Number of pairs computed together: two registers of eight doubles.
constexpr std::size_t width = 16;

struct alignas(64) Lanes {
  double corner[12][width];  ///< corner - point: x, y, z of the four corners
  double size[width];        ///< largest coordinate of the point
  double volume[4][width];   ///< of the point with the four faces
  double total[width];       ///< their sum
  double verdict[width];     ///< -1 outside, 0 undecided: locate() decides, 1 inside
};

void classify(Lanes& lanes) {
  for (std::size_t l = 0; l < width; ++l) {
    const auto c = [&](std::size_t corner, std::size_t axis) {
      return lanes.corner[3 * corner + axis][l];
    };
    // The same operations as in orientation(), so the weights have the same bits.
    const auto volume = [&](std::size_t i, std::size_t j, std::size_t k) {
      const double bycz = c(j, 1) * c(k, 2), bzcy = c(j, 2) * c(k, 1), bzcx = c(j, 2) * c(k, 0);
      const double bxcz = c(j, 0) * c(k, 2), bxcy = c(j, 0) * c(k, 1), bycx = c(j, 1) * c(k, 0);
      return c(i, 0) * (bycz - bzcy) + c(i, 1) * (bzcx - bxcz) + c(i, 2) * (bxcy - bycx);
    };
    const auto largest = [](double a, double b) { return a > b ? a : b; };
    const auto least = [](double a, double b) { return a < b ? a : b; };
    const auto reach = [&](std::size_t axis) {
      return largest(largest(std::abs(c(0, axis)), std::abs(c(1, axis))),
                     largest(std::abs(c(2, axis)), std::abs(c(3, axis))));
    };
    const double v0 = volume(1, 2, 3), v1 = volume(0, 3, 2), v2 = volume(0, 1, 3),
                 v3 = volume(0, 2, 1);
    const double total = (v0 + v1) + (v2 + v3);
    const double x = reach(0), y = reach(1), z = reach(2);
    const double r = largest(largest(x, y), z);
    const double product = x * y * z;
    const double error = 1.01 * volume_bound * product;
    // Upper bounds: an edge has at most the length sqrt(12) r, twice an area is at most its square,
    // and a coordinate of a corner is at most size + r.
    const double snap =
        error + 12.01 * (r * r) * (snap_edges * 3.5 * r + snap_ulps * (lanes.size[l] + r));
    const double low = least(least(v0, v1), least(v2, v3));
    const double high = largest(largest(v0, v1), largest(v2, v3));
    const double volume_found = std::abs(total);
    const double within = largest(low, -high);  // smallest volume, for positive orientation
    const double sure = least(within - error, volume_found - flat_limit * product);
    const double far = least(-low, high) - snap;
    lanes.verdict[l] = far > 0 ? -1.0 : (sure > 0 ? 1.0 : 0.0);
    lanes.volume[0][l] = v0;
    lanes.volume[1][l] = v1;
    lanes.volume[2][l] = v2;
    lanes.volume[3][l] = v3;
    lanes.total[l] = total;
  }
}

}  // namespace

void locate_pairs(std::span<const Point> points, std::span<const Tet> tets,
                  std::span<const Point> queries, std::span<const PointPair> pairs,
                  std::vector<Found>& found) {
  Lanes lanes{};
  for (std::size_t first = 0; first < pairs.size(); first += width) {
    const std::size_t n = std::min(width, pairs.size() - first);
#pragma GCC unroll 1
    for (std::size_t l = 0; l < n; ++l) {
      // Keeps g++ 12 from vectorising this loop: its shuffles take 5 ns per pair.
      asm volatile("" ::: "memory");
      const PointPair& pair = pairs[first + l];
      const Point& p = queries[static_cast<std::size_t>(pair.point)];
      const Tet& tet = tets[static_cast<std::size_t>(pair.tet)];
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const Point& at = points[static_cast<std::size_t>(tet[corner])];
        for (std::size_t axis = 0; axis < 3; ++axis)
          lanes.corner[3 * corner + axis][l] = at[axis] - p[axis];
      }
      lanes.size[l] = largest_coordinate(p);
    }
    classify(lanes);
    for (std::size_t l = 0; l < n; ++l) {
      if (lanes.verdict[l] < 0) continue;
      const auto index = static_cast<std::int32_t>(first + l);
      if (lanes.verdict[l] > 0) {
        const double total = lanes.total[l];
        const Weights weights{lanes.volume[0][l] / total, lanes.volume[1][l] / total,
                              lanes.volume[2][l] / total, lanes.volume[3][l] / total};
        found.push_back({index, {weights, 0, Status::inside}});
        continue;
      }
      const PointPair& pair = pairs[first + l];
      const auto location = locate(queries[static_cast<std::size_t>(pair.point)],
                                   corners_of(points, tets[static_cast<std::size_t>(pair.tet)]));
      if (location) found.push_back({index, *location});
    }
  }
}

}  // namespace tess::m2m
