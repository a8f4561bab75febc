// Point in tetrahedron and barycentric weights, from the signed volumes of the four tetrahedra that
// the point forms with the faces. All differences are taken to the query point first, so that an
// offset of 1e9 loses no digit that the coordinates hold. Pure functions of their arguments: the
// same bits on every PE and in every batch.
//
// Guaranteed, for edges from 1e-80 to 1e100 and any flatness: inside, boundary and outside are
// decided exactly; weights are within 1e-12 of the exact ones; a point equal to a vertex has the
// weights 1, 0, 0, 0; a tetrahedron without volume claims no other point. A point outside, but
// within the tolerance, snaps: its weights extrapolate over that distance, so that a linear field
// stays exact and one weight may be slightly negative.
#pragma once

#include "m2m/interpolate/candidate.hpp"
#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tess::m2m {

/// A point outside snaps up to this distance from each face: a part of the longest edge, plus some
/// ulps of the largest coordinate of the tetrahedron.
inline constexpr double snap_edges = 1e-10;
inline constexpr double snap_ulps = 4 * 0x1p-52;

using Weights = std::array<double, 4>;

/// A point within a tetrahedron, or so near that it snaps.
struct Location {
  Weights weights;   ///< sum 1, of the tetrahedron's vertices in its order
  double violation;  ///< max(0, -least weight)
  Status status;     ///< inside, boundary or snapped
  Place place = Place::elsewhere;
};

/// The claim of the tetrahedron of that global number, where the point is located in it.
[[nodiscard]] inline Candidate claim_of(const Location& location, GlobalId tet) noexcept {
  return {location.violation, tet, location.status, location.place};
}

/// Where `p` lies with respect to the tetrahedron of these corners; nothing where it is outside
/// beyond the tolerance.
[[nodiscard]] std::optional<Location> locate(const Point& p, const std::array<Point, 4>& corners);

/// Pairs a source tetrahedron with a target point that may lie in it; both index the spans given
/// beside.
struct PointPair {
  std::int32_t tet;
  std::int32_t point;
};

/// A pair of the batch whose point lies in (or snaps to) the tetrahedron.
struct Found {
  std::int32_t pair;  ///< index into the batch
  Location location;
};

/// locate() for many pairs at once, vectorised; appends the pairs that hold, in order. The same
/// bits as locate().
void locate_pairs(std::span<const Point> points, std::span<const Tet> tets,
                  std::span<const Point> queries, std::span<const PointPair> pairs,
                  std::vector<Found>& found);

/// The box of a tetrahedron, padded so that it holds every point that locate() would snap to it:
/// the source's boxes for the broad phase. Target points need no padding.
[[nodiscard]] Aabb search_box(const std::array<Point, 4>& corners);

/// The four points of a tetrahedron.
[[nodiscard]] inline std::array<Point, 4> corners_of(std::span<const Point> points,
                                                     const Tet& tet) {
  const auto at = [&](std::size_t corner) { return points[static_cast<std::size_t>(tet[corner])]; };
  return {at(0), at(1), at(2), at(3)};
}

/// One component of a field at a location: values[vertex * stride]. A weight of 1 copies the value
/// bit for bit.
[[nodiscard]] inline double weigh(const Weights& weights, const Tet& tet, const double* values,
                                  std::size_t stride) {
  const auto value = [&](std::size_t corner) {
    return values[static_cast<std::size_t>(tet[corner]) * stride];
  };
  for (std::size_t corner = 0; corner < 4; ++corner) {
    if (weights[corner] == 1) return value(corner);
  }
  return (weights[0] * value(0) + weights[1] * value(1)) +
         (weights[2] * value(2) + weights[3] * value(3));
}

}  // namespace tess::m2m
