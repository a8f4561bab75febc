// What one source tetrahedron says about one target point, and which of two such answers wins. The
// order is total, so that answers of any number of source parts may be merged in any order and
// grouping with one result.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <limits>

namespace tess::m2m {

/// Where a target point lies with respect to the source mesh.
enum class Status : std::uint8_t {
  inside,    ///< strictly inside its tetrahedron
  boundary,  ///< exactly on a face, edge or vertex of it
  snapped,   ///< outside all, within the tolerance of its tetrahedron
  outside,   ///< in no tetrahedron: the policy gave its value
};
[[nodiscard]] constexpr const char* name_of(Status status) noexcept {
  constexpr std::array names{"inside", "boundary", "snapped", "outside"};
  return names[static_cast<std::size_t>(status)];
}

/// Where the point is on its tetrahedron: at a corner, or anywhere else.
enum class Place : std::uint8_t { corner, elsewhere };

/// The claim of a tetrahedron to a point. Values travel beside it, one row for each candidate.
struct Candidate {
  double violation = std::numeric_limits<double>::infinity();  ///< max(0, -least weight): 0 within
                                                               ///< the closed tetrahedron
  GlobalId tet =
      std::numeric_limits<GlobalId>::max();  ///< in the numbering of the whole source mesh
  Status status = Status::outside;
  Place place = Place::elsewhere;
};

/// Whether `a` wins against `b`: a corner that coincides with the point, then smaller violation,
/// then lower tetrahedron. The corner comes first so that a mesh transferred onto itself returns
/// its values also where it does not conform (a vertex on a face of a tetrahedron that does not use
/// it). A strict total order for distinct tetrahedra.
[[nodiscard]] constexpr bool better(const Candidate& a, const Candidate& b) noexcept {
  if (a.place != b.place) return a.place == Place::corner;
  return a.violation < b.violation || (a.violation == b.violation && a.tet < b.tet);
}

}  // namespace tess::m2m
