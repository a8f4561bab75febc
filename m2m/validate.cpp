// Checks a mesh before it is used.
#include "m2m/mesh_view.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

void validate_groups(const TetMesh& mesh) {
  std::size_t n_in_blocks = 0;
  for (const Block& block : mesh.blocks) n_in_blocks += block.n_tets;
  if (!mesh.blocks.empty() && n_in_blocks != mesh.n_tets())
    fail(ErrorCode::bad_mesh, mesh.name, ": its blocks have ", n_in_blocks, " of ", mesh.n_tets(),
         " tetrahedra; list blocks for all tetrahedra, or none");
  for (const SideSet& set : mesh.side_sets) {
    for (const Side& side : set.entries) {
      if (side.tet < 0 || side.tet >= static_cast<GlobalId>(mesh.n_tets()) || side.side < 1 ||
          side.side > 4)
        fail(ErrorCode::bad_mesh, mesh.name, ": side set ", set.id, " names side ", side.side,
             " of tetrahedron ", side.tet, " (counted from 0) of ", mesh.n_tets(),
             "; write the mesh again");
    }
  }
  for (const NodeSet& set : mesh.node_sets) {
    for (const VertexId v : set.entries) {
      if (v < 0 || static_cast<std::size_t>(v) >= mesh.n_points())
        fail(ErrorCode::bad_mesh, mesh.name, ": node set ", set.id, " names vertex ", v,
             " (counted from 0) of ", mesh.n_points(), "; write the mesh again");
    }
  }
}

std::array<Point, 4> corners_at(const TetMesh& mesh, std::size_t tet) {
  std::array<Point, 4> corners;
  for (std::size_t k = 0; k < 4; ++k)
    corners[k] = mesh.points[static_cast<std::size_t>(mesh.tets[tet][k])];
  return corners;
}

/// Counts tetrahedra that are too short for their coordinates, or for any computation.
class Collapse {
 public:
  void add(const std::array<Point, 4>& corners) {
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
    if (n_++ == 0) first_ = {longest, largest, rounded};
  }

  /// Throws if more than a tenth of the tetrahedra are too short.
  void refuse(const TetMesh& mesh) const {
    if (n_ <= mesh.n_tets() / 10) return;
    const auto refuse = [&](const auto&... reason) {
      fail(ErrorCode::bad_mesh, mesh.name, ": ", n_, " of ", mesh.n_tets(),
           " tetrahedra have collapsed: the first is ", first_.longest, " long", reason...);
    };
    if (first_.rounded)
      refuse(" at coordinates of ", first_.largest, ", where neighbouring numbers differ by ",
             first_.largest * ulp,
             "; shift the mesh towards the origin before its coordinates are rounded");
    refuse(", and lengths below ", least_edge,
           " have no volume in floating point; rescale the mesh");
  }

 private:
  static constexpr double ulp = 0x1p-52;
  static constexpr double least_ulps = 64;
  static constexpr double least_edge = 1e-80;
  struct First {
    double longest = 0, largest = 0;
    bool rounded = false;
  };
  std::size_t n_ = 0;
  First first_;
};

}  // namespace

MeshCensus validate(const TetMesh& mesh) {
  const std::size_t n = mesh.n_points();
  if (mesh.tets.empty()) {
    const std::string others = skipped_text(mesh);
    fail(ErrorCode::bad_mesh, mesh.name, ": has no tetrahedra",
         others.empty() ? "" : " (but " + others + ")", "; give a volume mesh");
  }
  validate_groups(mesh);
  if (n > static_cast<std::size_t>(std::numeric_limits<VertexId>::max())) {
    fail(ErrorCode::bad_mesh, mesh.name, ": has ", n,
         " vertices; at most 2147483647 fit in one mesh, split it");
  }
  constexpr double largest = 1e100;  // volumes (cubes of lengths) stay in the range of double
  for (std::size_t v = 0; v < n; ++v) {
    const Point& p = mesh.points[v];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(p[axis]) || std::abs(p[axis]) > largest) {
        fail(ErrorCode::bad_mesh, mesh.name, ": vertex ", v, " has ", "xyz"[axis], " = ", p[axis],
             "; coordinates must be finite and at most 1e100: repair or rescale the mesh");
      }
    }
  }
  std::vector<char> used(n, 0);
  MeshCensus census;
  Collapse collapse;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    for (const VertexId v : mesh.tets[t]) {
      if (v < 0 || static_cast<std::size_t>(v) >= n) {
        fail(ErrorCode::bad_mesh, mesh.name, ": tetrahedron ", t, " names vertex ", v,
             " (counted from 0) of ", n, " vertices; write the mesh again");
      }
      used[static_cast<std::size_t>(v)] = 1;
    }
    collapse.add(corners_at(mesh, t));
    const double volume = signed_volume(mesh, t);
    census.n_flat += volume == 0;
    census.n_inverted += volume < 0;
  }
  collapse.refuse(mesh);
  if (census.n_flat == mesh.n_tets())
    fail(
        ErrorCode::bad_mesh, mesh.name,
        ": no tetrahedron has a volume; give a mesh in three dimensions, written with more digits");
  census.n_unused = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
  census.bounds = bounds(mesh);
  return census;
}

void validate(const MeshView& mesh) {
  const auto n = static_cast<VertexId>(mesh.points.size());
  if (mesh.n_owned < 0 || mesh.n_owned > n)
    fail(ErrorCode::bad_mesh, "a piece owns ", mesh.n_owned, " of ", n,
         " points; n_owned counts points of the piece");
  if (mesh.n_own_tets > static_cast<std::int64_t>(mesh.tets.size()))
    fail(ErrorCode::bad_mesh, "a piece has ", mesh.n_own_tets, " own tetrahedra of ",
         mesh.tets.size(), "; n_own_tets counts tetrahedra of the piece");
  if (mesh.tet_ids.size() != mesh.tets.size() || mesh.point_ids.size() != mesh.points.size())
    fail(ErrorCode::bad_mesh, "a piece of ", n, " points and ", mesh.tets.size(),
         " tetrahedra has ", mesh.point_ids.size(), " point_ids and ", mesh.tet_ids.size(),
         " tet_ids; give an id for each");
  // Each search validates, so the passes that decide have no branch and are vectorised.
  const auto is_bad = [](double x) { return !(std::abs(x) <= 1e100); };
  bool bad = false;
  for (const Point& p : mesh.points) bad |= is_bad(p[0]) | is_bad(p[1]) | is_bad(p[2]);
  if (bad)
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      for (const double x : mesh.points[i])
        if (is_bad(x))
          fail(ErrorCode::bad_mesh, "point ", i, " of a piece has the coordinate ", x,
               "; coordinates must be finite and at most 1e100");
  const auto out_of_range = [n](VertexId v) { return (v < 0) | (v >= n); };
  for (const Tet& tet : mesh.tets)
    bad |=
        out_of_range(tet[0]) | out_of_range(tet[1]) | out_of_range(tet[2]) | out_of_range(tet[3]);
  if (bad)
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (const VertexId v : mesh.tets[t])
        if (out_of_range(v))
          fail(ErrorCode::bad_mesh, "tetrahedron ", t, " of a piece names point ", v,
               ", but the piece has ", n, " points");
}

}  // namespace tess::m2m
