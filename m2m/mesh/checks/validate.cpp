// Checks a mesh before it is used.
#include "m2m/mesh/checks/mesh_findings.hpp"
#include "m2m/mesh_view.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace tess::m2m {
namespace {

void validate_groups(const TetMesh& mesh) {
  std::size_t n_in_blocks = 0;
  for (const Block& block : mesh.blocks) n_in_blocks += block.n_tets;
  if (!mesh.blocks.empty() && n_in_blocks != mesh.n_tets())
    fail(ErrorCode::bad_mesh, mesh.name, ": its blocks have ", n_in_blocks, " of ", mesh.n_tets(),
         " ", cells_of(mesh.dimension), "; list blocks for all of them, or none");
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

/// Fails for two equal ids of a piece. They usually ascend, which one pass shows.
void require_unique(std::span<const GlobalId> ids, const char* what, const char* list) {
  if (std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end()) return;
  std::vector<std::pair<GlobalId, std::size_t>> sorted;
  for (std::size_t i = 0; i < ids.size(); ++i) sorted.emplace_back(ids[i], i);
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first)
      fail(ErrorCode::bad_mesh, what, " ", sorted[i - 1].second, " and ", sorted[i].second,
           " of a piece have the same id ", sorted[i].first, ": ", list, " are unique in the mesh");
}

}  // namespace

void require_elements(std::span<const std::int64_t> of_tet, std::span<const VertexId> vertices,
                      std::span<const Tet> tets, std::size_t n_points) {
  if (!of_tet.empty() && of_tet.size() != tets.size())
    fail(ErrorCode::bad_mesh, "elements of ", of_tet.size(), " of ", tets.size(),
         " tetrahedra are given; give each its element, or none");
  std::int64_t last = -1;  // the element of the tetrahedron before, whose vertices are checked
  for (std::size_t t = 0; t < of_tet.size(); ++t) {
    const std::int64_t at = of_tet[t];
    if (at == -1) continue;
    const auto size = static_cast<std::int64_t>(vertices.size());
    const std::int64_t n = at < 0 || at >= size ? 0 : vertices[static_cast<std::size_t>(at)];
    if (!is_native(n) || n >= size - at)
      fail(ErrorCode::bad_mesh, "the element of tetrahedron ", t, " begins at ", at, " of ", size,
           " numbers and has ", n,
           " vertices; give the number of vertices of a supported element, and then these");
    const std::span<const VertexId> element = vertices_of_element(vertices, at);
    for (const VertexId v : tets[t])
      if (std::ranges::find(element, v) == element.end())
        fail(ErrorCode::bad_mesh, "tetrahedron ", t, " has the corner ", v,
             ", which is no vertex of its element; give the element that it was split from");
    if (std::exchange(last, at) == at) continue;
    for (const VertexId v : element)
      if (v < 0 || static_cast<std::size_t>(v) >= n_points)
        fail(ErrorCode::bad_mesh, "the element of tetrahedron ", t, " names vertex ", v, " of ",
             n_points, "; indices count from 0");
  }
}

MeshCensus validate(const TetMesh& mesh) {
  const auto n = static_cast<GlobalId>(mesh.n_points());
  refuse_bad_counts(mesh.name, mesh.n_points(), mesh.n_tets(), skipped_text(mesh), mesh.dimension);
  validate_groups(mesh);
  MeshFindings findings;
  findings.dimension = mesh.dimension;
  findings.add_points(0, mesh.points);
  findings.add_corners(0, mesh.tets, n);
  findings.refuse_bad_ids(mesh.name, n);
  require_elements(mesh.elements.of_tet, mesh.elements.vertices, mesh.tets, mesh.n_points());
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    findings.add_shape(static_cast<GlobalId>(t), corners_of(mesh.points, mesh.tets[t]));
  findings.refuse_bad_shapes(mesh.name, mesh.n_tets());
  return {findings.n_flat, findings.n_inverted, n_unused(mesh), findings.bounds};
}

void validate(const MeshView& mesh) {
  const auto n = static_cast<VertexId>(mesh.points.size());
  if (mesh.n_owned < 0 || mesh.n_owned > n)
    fail(ErrorCode::bad_mesh, "a piece owns ", mesh.n_owned, " of ", n,
         " points; n_owned counts points of the piece");
  if (mesh.n_own_tets < -1 || mesh.n_own_tets > static_cast<std::int64_t>(mesh.tets.size()))
    fail(ErrorCode::bad_mesh, "a piece has ", mesh.n_own_tets, " own tetrahedra of ",
         mesh.tets.size(), "; n_own_tets counts tetrahedra of the piece, or is -1 for all");
  if (mesh.tet_ids.size() != mesh.tets.size() || mesh.point_ids.size() != mesh.points.size())
    fail(ErrorCode::bad_mesh, "a piece of ", n, " points and ", mesh.tets.size(),
         " tetrahedra has ", mesh.point_ids.size(), " point_ids and ", mesh.tet_ids.size(),
         " tet_ids; give an id for each");
  if (mesh.dimension < 1 || mesh.dimension > 3)
    fail(ErrorCode::bad_mesh, "a piece has the dimension ", mesh.dimension,
         "; choose 3 for tetrahedra, 2 for triangles or 1 for edges");
  require_unique(mesh.tet_ids, cells_of(mesh.dimension), "tet_ids");
  // Each search validates, so the passes that decide have no branch and are vectorised.
  const auto is_bad = [](double x) { return !(std::abs(x) <= 1e100); };
  bool bad = false;
  for (const Point& p : mesh.points) bad |= is_bad(p[0]) | is_bad(p[1]) | is_bad(p[2]);
  if (bad)
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      for (const double x : mesh.points[i])
        if (is_bad(x))
          fail(ErrorCode::bad_mesh, "point ", i, " of a piece, with the id ", mesh.point_ids[i],
               ", has the coordinate ", x, "; coordinates must be finite and at most 1e100");
  const auto out_of_range = [n](VertexId v) { return (v < 0) | (v >= n); };
  for (const Tet& tet : mesh.tets)
    bad |=
        out_of_range(tet[0]) | out_of_range(tet[1]) | out_of_range(tet[2]) | out_of_range(tet[3]);
  if (bad)
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (const VertexId v : mesh.tets[t])
        if (out_of_range(v))
          fail(ErrorCode::bad_mesh, cell_of(mesh.dimension), " ", t, " of a piece, with the id ",
               mesh.tet_ids[t], ", names point ", v, ", but the piece has ", n,
               " points; indices count from 0"
               " within the piece");
  require_elements(mesh.element_of_tet, mesh.element_vertices, mesh.tets, mesh.points.size());
  if (mesh.dimension == 3) return;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (!has_dimension(mesh.tets[t], mesh.dimension))
      fail(ErrorCode::bad_mesh, "a piece's ",
           wrong_cell_text(mesh.tet_ids[t], mesh.tets[t], mesh.dimension));
}

}  // namespace tess::m2m
