// Finds the best source tetrahedron of each point: the narrow phase of a search.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/interpolate/donor.hpp"
#include "m2m/rows/search/cover.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// The best candidates among some tetrahedra of a part, for the points of a list that have one.
struct BestDonors {
  std::vector<std::uint32_t> points;  ///< ascending
  std::vector<Candidate> candidates;  ///< per point found
  std::vector<Donor> donors;          ///< per point found
  std::vector<std::int32_t> tets;     ///< per point found, in the part
};

/// Searches the tetrahedra of some boxes of the mesh's cover, each box given once, in one pass for
/// several lists of points. A point that none of them holds snaps to the nearest within the
/// tolerance (a length), which the cover reaches. Returns the candidates per list, and in `n_tested`
/// the number of pairs of a tetrahedron and a point in its box.
[[nodiscard]] std::vector<BestDonors> best_donors(const MeshView& mesh, const Cover& cover,
                                                  std::span<const std::uint32_t> boxes,
                                                  std::span<const std::span<const Point>> lists,
                                                  double tolerance, std::uint64_t& n_tested);

}  // namespace tess::m2m
