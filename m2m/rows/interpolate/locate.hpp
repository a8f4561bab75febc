// Decides whether a point lies in a tetrahedron, and computes its barycentric weights, from the
// signed volumes of the four tetrahedra that the point forms with the faces. All coordinates are
// taken relative to the point first, so an offset of 1e9 loses no digit that the coordinates hold.
// The functions are pure: they give the same bits on every PE and in every batch.
//
// Guarantees, for edges from 1e-80 to 1e100 and any flatness:
//   - inside, boundary and outside are decided exactly;
//   - weights are within 1e-12 of the exact ones;
//   - a point equal to a vertex has the weight 1 there, and 0 at the others;
//   - a tetrahedron without volume holds no point except its corners.
// A point outside, but within the tolerance, snaps to the tetrahedron. Its weights extrapolate over
// that distance: a linear field stays exact, and a weight may be slightly negative, down to -1e-6.
// Of a tetrahedron that is so flat, or so small beside its coordinates, that they would extrapolate
// more, it gets the weights of the nearest point: a linear field is wrong by its change over the
// distance.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/rows/interpolate/candidate.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tess::m2m {

/// A point outside snaps up to this distance from each face: snap_edges times the longest edge,
/// plus snap_ulps times the largest coordinate of the tetrahedron.
inline constexpr double snap_edges = 1e-10;
inline constexpr double snap_ulps = 4 * 0x1p-52;
/// This distance.
[[nodiscard]] double snap_reach(const std::array<Point, 4>& corners);

using Weights = std::array<double, 4>;

/// The position of a point that lies in a tetrahedron or snaps to it.
struct Location {
  Weights weights;  ///< per vertex of the tetrahedron, in its order; their sum is 1
  double distance;  ///< from the closed tetrahedron, in units of the mesh: 0 unless snapped
  Status status;    ///< inside, boundary or snapped
  Place place = Place::elsewhere;
};

/// The location as a candidate of the tetrahedron with the global id `tet`.
[[nodiscard]] inline Candidate candidate_of(const Location& location, GlobalId tet) noexcept {
  return {location.distance, tet, location.status, location.place};
}

/// The location of `p` in the tetrahedron with these corners. Empty if `p` is outside and does not
/// snap.
[[nodiscard]] std::optional<Location> locate(const Point& p, const std::array<Point, 4>& corners);

/// A source tetrahedron and a target point that may lie in it, as indices into the spans that
/// locate_pairs() takes.
struct PointPair {
  std::int32_t tet;
  std::int32_t point;
};

/// A pair of a batch whose point lies in the tetrahedron or snaps to it.
struct Found {
  std::int32_t pair;  ///< index into the batch
  Location location;
};

/// Calls locate() for many pairs at once, vectorised, with the same bits. Appends the pairs that
/// have a location to `found`, in order.
void locate_pairs(std::span<const Point> points, std::span<const Tet> tets,
                  std::span<const Point> queries, std::span<const PointPair> pairs,
                  std::vector<Found>& found);

/// The box of a tetrahedron, padded so that it holds every point that snaps to the tetrahedron. The
/// broad phase uses it for the source; target points need no padding.
[[nodiscard]] Aabb search_box(const std::array<Point, 4>& corners);

/// Contains the search_box() of every tetrahedron with corners in `box`, extended by `reach`, and
/// costs less.
[[nodiscard]] inline Aabb padded(const Aabb& box, double reach = 0) {
  double extent = 0, largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    extent += box.hi[axis] - box.lo[axis];  // the sum is at least an edge
    largest = std::max({largest, -box.lo[axis], box.hi[axis]});
  }
  // The multiple of the largest coordinate also covers the rounding of box and reach.
  const double pad = 2.01 * (snap_edges * extent + snap_ulps * (largest + reach)) + reach;
  Aabb out = box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.lo[axis] -= pad;
    out.hi[axis] += pad;
  }
  return out;
}

/// The product, and 0 for a weight of 0 and a value that is not finite.
[[nodiscard]] inline double weighted(double weight, double value) {
  const double product = weight * value;
  return weight == 0 && product != product ? 0 : product;  // NaN
}

/// Interpolates one component of a field; the value of a vertex is values[vertex * stride]. A
/// weight of 1 copies the value bit for bit; a weight of 0 takes nothing, not even of NaN.
[[nodiscard]] inline double interpolated(const Weights& weights, const Tet& tet,
                                         const double* values, std::size_t stride) {
  const auto value = [&](std::size_t corner) {
    return values[static_cast<std::size_t>(tet[corner]) * stride];
  };
  for (std::size_t corner = 0; corner < 4; ++corner) {
    if (weights[corner] == 1) return value(corner);
  }
  const auto part = [&](std::size_t corner) { return weighted(weights[corner], value(corner)); };
  return (part(0) + part(1)) + (part(2) + part(3));
}

}  // namespace tess::m2m
