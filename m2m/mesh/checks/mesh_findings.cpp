#include "m2m/mesh/checks/mesh_findings.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

constexpr double ulp = 0x1p-52;
constexpr double least_ulps = 64;
constexpr double least_edge = 1e-80;
constexpr double most_coordinate = 1e100;  // volumes stay in the range of double

bool can_be_used(double x) {
  return std::abs(x) <= most_coordinate;  // false for NaN
}

/// An application may leave its mesh without a name.
std::string shown(const std::string& name) {
  return name.empty() ? "the mesh" : name;
}

/// Keeps the finding with the least id.
template <class Finding>
void keep_first(Finding& a, const Finding& b, GlobalId Finding::*id) {
  if (b.*id >= 0 && (a.*id < 0 || b.*id < a.*id)) a = b;
}

}  // namespace

std::string wrong_cell_text(GlobalId id, const Tet& cell, std::int32_t dimension) {
  return text(cell_of(dimension), " ", id, " is (", cell[0], ", ", cell[1], ", ", cell[2], ", ",
              cell[3], "), but ",
              dimension == 2 ? "a triangle is (a, b, c, c)" : "an edge is (a, b, b, b)",
              "; cells of each dimension make a mesh of their own");
}

void MeshFindings::add_points(GlobalId first, std::span<const Point> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    if (!std::all_of(p.begin(), p.end(), can_be_used))
      keep_first(bad_point, {first + static_cast<GlobalId>(i), p}, &BadPoint::point);
  }
  bounds = collide::merged(bounds, collide::box_around(points));
}

void MeshFindings::add_corners(GlobalId first, std::span<const Tet> tets, GlobalId n_points) {
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const GlobalId id = first + static_cast<GlobalId>(t);
    for (const VertexId v : tets[t])
      if (v < 0 || v >= n_points) keep_first(bad_corner, {id, v}, &BadCorner::tet);
    if (!has_dimension(tets[t], dimension)) keep_first(bad_cell, {id, tets[t]}, &BadCell::tet);
  }
}

void MeshFindings::add_shape(GlobalId tet, const std::array<Point, 4>& corners) {
  const double volume = dimension == 3 ? signed_volume(corners) : measure(corners, dimension);
  n_flat += volume == 0 ? 1 : 0;
  n_inverted += volume < 0 ? 1 : 0;
  double longest = 0, largest = 0;  // per axis
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = corners[0][axis], high = low;
    for (const Point& p : corners) {
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    longest = std::max(longest, high - low);
    largest = std::max({largest, std::abs(low), std::abs(high)});
  }
  const bool rounded = longest < least_ulps * ulp * largest;
  if (!rounded && !(longest < least_edge)) return;
  ++n_collapsed;
  keep_first(collapsed, {tet, longest, largest, rounded ? 1 : 0}, &Collapsed::tet);
}

void MeshFindings::join(const MeshFindings& other) {
  keep_first(bad_point, other.bad_point, &BadPoint::point);
  keep_first(bad_corner, other.bad_corner, &BadCorner::tet);
  keep_first(bad_cell, other.bad_cell, &BadCell::tet);
  keep_first(collapsed, other.collapsed, &Collapsed::tet);
  n_collapsed += other.n_collapsed;
  n_flat += other.n_flat;
  n_inverted += other.n_inverted;
  bounds = collide::merged(bounds, other.bounds);
}

void MeshFindings::refuse_bad_ids(const std::string& name, GlobalId n_points) const {
  if (bad_point.point >= 0) {
    const auto axis = std::find_if_not(bad_point.at.begin(), bad_point.at.end(), can_be_used) -
                      bad_point.at.begin();
    fail(ErrorCode::bad_mesh, shown(name), ": vertex ", bad_point.point, " has ", "xyz"[axis],
         " = ", bad_point.at[static_cast<std::size_t>(axis)],
         "; coordinates must be finite and at most 1e100: repair or rescale the mesh");
  }
  if (bad_corner.tet >= 0)
    fail(ErrorCode::bad_mesh, shown(name), ": ", cell_of(dimension), " ", bad_corner.tet,
         " names vertex ", bad_corner.corner, " (counted from 0) of ", n_points,
         " vertices; write the mesh again");
  if (bad_cell.tet >= 0)
    fail(ErrorCode::bad_mesh, shown(name), ": ",
         wrong_cell_text(bad_cell.tet, bad_cell.corners, dimension));
}

void MeshFindings::refuse_bad_shapes(const std::string& name, std::uint64_t n_tets) const {
  const auto refuse = [&](const auto&... reason) {
    fail(ErrorCode::bad_mesh, shown(name), ": ", n_collapsed, " of ", n_tets, " ",
         cells_of(dimension), " have collapsed: the first is ", collapsed.longest, " long",
         reason...);
  };
  if (n_collapsed > n_tets / 10) {
    if (collapsed.rounded != 0)
      refuse(" at coordinates of ", collapsed.largest, ", where neighbouring numbers differ by ",
             collapsed.largest * ulp,
             "; shift the mesh towards the origin before its coordinates are rounded");
    refuse(", and lengths below ", least_edge,
           " have no volume in floating point; rescale the mesh");
  }
  if (n_flat == n_tets)
    fail(ErrorCode::bad_mesh, name, ": no ", cell_of(dimension),
         dimension == 3
             ? " has a volume; give a mesh in three dimensions, or triangles with dimension 2,"
         : dimension == 2 ? " has an area; give a surface"
                          : " has a length; give a line",
         " written with more digits");
}

void refuse_bad_counts(const std::string& name, std::uint64_t n_points, std::uint64_t n_tets,
                       const std::string& others, std::int32_t dimension) {
  if (dimension < 1 || dimension > 3)
    fail(ErrorCode::bad_mesh, shown(name), ": has the dimension ", dimension,
         "; choose 3 for tetrahedra, 2 for triangles or 1 for edges");
  if (n_tets == 0)
    fail(ErrorCode::bad_mesh, shown(name), ": has no ", cells_of(dimension),
         others.empty() ? "" : " (but " + others + ")", "; give a ",
         dimension == 3   ? "volume mesh"
         : dimension == 2 ? "surface"
                          : "line");
  if (n_points > static_cast<std::uint64_t>(std::numeric_limits<VertexId>::max()))
    fail(ErrorCode::bad_mesh, shown(name), ": has ", n_points,
         " vertices; at most 2147483647 fit in one mesh, split it");
  if (n_tets > static_cast<std::uint64_t>(std::numeric_limits<VertexId>::max()))
    fail(ErrorCode::bad_mesh, shown(name), ": has ", n_tets, " ", cells_of(dimension),
         "; at most 2147483647 fit in one mesh, split it");
}

}  // namespace tess::m2m
