// A candidate is a source tetrahedron that holds a target point, with the quality of the match. The
// best candidate gives the point its value. The order of candidates is total, so the answers of any
// number of source parts can be merged in any order and grouping, always with the same result.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/status.hpp"

#include <cstdint>
#include <limits>

namespace tess::m2m {

/// The position of a point in its tetrahedron: at a corner, or anywhere else.
enum class Place : std::uint8_t { corner, elsewhere };

/// The default value means that no candidate is known; every other candidate is better.
struct Candidate {
  /// from the closed tetrahedron, in units of the mesh; 0 within it
  double distance = std::numeric_limits<double>::infinity();
  /// global id in the source mesh
  GlobalId tet = std::numeric_limits<GlobalId>::max();
  Status status = Status::outside;
  Place place = Place::elsewhere;
  /// of a triangle, on which the point is: side_of() (foot.hpp); otherwise 0
  std::int8_t side = 0;
};

/// True if `a` is better than `b`. A corner that coincides with the point comes first, then
/// tetrahedra that hold the point, then the nearer one, then the lower one. With corners first, a
/// mesh that is transferred onto itself keeps its values even if it does not conform (a vertex on
/// the face of a tetrahedron that does not use it). This is a strict total order of distinct
/// tetrahedra.
[[nodiscard]] constexpr bool better(const Candidate& a, const Candidate& b) noexcept {
  if (a.place != b.place) return a.place == Place::corner;
  const bool a_holds = a.status < Status::snapped, b_holds = b.status < Status::snapped;
  if (a_holds != b_holds) return a_holds;
  return a.distance < b.distance || (a.distance == b.distance && a.tet < b.tet);
}

}  // namespace tess::m2m
