#include "m2m/mesh/partition/split.hpp"

#include "m2m/rows/weights/tets_of_vertices.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace tess::m2m {
namespace {

/// Lists the ghosts of all parts at their owners.
void list_ghosts(std::vector<MeshPart>& parts, std::span<const std::int32_t> owner) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const MeshPart& user = parts[p];
    for (auto v = static_cast<std::size_t>(user.n_owned); v < user.points.size(); ++v) {
      MeshPart& of =
          parts[static_cast<std::size_t>(owner[static_cast<std::size_t>(user.point_ids[v])])];
      const auto owned_end = of.point_ids.begin() + of.n_owned;
      const auto at = std::lower_bound(of.point_ids.begin(), owned_end, user.point_ids[v]);
      if (of.ghosts.empty() || of.ghosts.back().part != static_cast<std::int32_t>(p))
        of.ghosts.push_back({static_cast<std::int32_t>(p), {}, {}});
      of.ghosts.back().here.push_back(static_cast<std::int32_t>(at - of.point_ids.begin()));
      of.ghosts.back().there.push_back(static_cast<std::int32_t>(v));
    }
  }
}

/// Adds the tetrahedra that share a vertex with the part, and their vertices.
void add_layer(const TetMesh& mesh, const TetsOfVertices& around, MeshPart& part) {
  std::vector<GlobalId> halo(part.tet_ids.begin() + part.n_own_tets, part.tet_ids.end());
  part.tet_ids.resize(static_cast<std::size_t>(part.n_own_tets));
  for (const GlobalId v : part.point_ids)
    for (const std::int32_t t : around[static_cast<VertexId>(v)]) halo.push_back(t);
  sort_unique(halo);
  std::vector<GlobalId> others;
  std::set_difference(halo.begin(), halo.end(), part.tet_ids.begin(), part.tet_ids.end(),
                      std::back_inserter(others));
  part.tet_ids.insert(part.tet_ids.end(), others.begin(), others.end());
  for (const GlobalId t : others)
    for (const VertexId v : mesh.tets[static_cast<std::size_t>(t)]) part.point_ids.push_back(v);
  sort_unique(part.point_ids);
}

/// Calls visit(tetrahedron, vertices of its element) for the part's own tetrahedra; for those that
/// follow another one of the same element without vertices.
template <class Visit>
void for_elements(const NativeElements& all, const MeshPart& part, const Visit& visit) {
  std::int64_t last = -1;
  for (std::size_t t = 0; t < static_cast<std::size_t>(part.n_own_tets); ++t) {
    const std::int64_t at = all.of_tet[static_cast<std::size_t>(part.tet_ids[t])];
    if (at >= 0) visit(t, at == last ? std::span<const VertexId>() : all.vertices_at(at));
    last = at;
  }
}

void take_elements(const NativeElements& all, std::span<const VertexId> local, MeshPart& part) {
  NativeElements& here = part.elements;
  here.of_tet.assign(part.tet_ids.size(), -1);
  std::int64_t next = 0;
  for_elements(all, part, [&](std::size_t t, std::span<const VertexId> element) {
    if (!element.empty()) {
      next = std::ssize(here.vertices);
      here.vertices.push_back(static_cast<VertexId>(element.size()));
      for (const VertexId v : element) here.vertices.push_back(local[static_cast<std::size_t>(v)]);
    }
    here.of_tet[t] = next;
  });
}

}  // namespace

std::vector<MeshPart> split(const TetMesh& mesh, std::span<const std::int32_t> parts,
                            std::int32_t n_parts, std::int32_t halo_layers) {
  if (halo_layers < 0)
    fail(ErrorCode::bad_argument, "a halo of ", halo_layers, " layers; choose 0 or more");
  TESS_CHECK(parts.size() == mesh.n_tets(), "expected ", mesh.n_tets(),
             " entries, one per tetrahedron, got ", parts.size());
  constexpr std::int32_t no_owner = std::numeric_limits<std::int32_t>::max();
  const std::size_t n = mesh.n_points();
  std::vector<MeshPart> result(static_cast<std::size_t>(n_parts));
  std::vector<std::int32_t> owner(n, no_owner);
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    TESS_CHECK(parts[t] >= 0 && parts[t] < n_parts, "tetrahedron ", t, " is in part ", parts[t],
               " of ", n_parts);
    result[static_cast<std::size_t>(parts[t])].tet_ids.push_back(static_cast<GlobalId>(t));
    for (const VertexId v : mesh.tets[t]) {
      std::int32_t& least = owner[static_cast<std::size_t>(v)];
      least = std::min(least, parts[t]);
    }
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (owner[v] != no_owner) continue;  // no tetrahedron uses it: spread over the parts
    owner[v] = static_cast<std::int32_t>(v * static_cast<std::size_t>(n_parts) / n);
    result[static_cast<std::size_t>(owner[v])].point_ids.push_back(static_cast<GlobalId>(v));
  }
  const bool has_elements = !mesh.elements.of_tet.empty();
  const bool keeps_elements = has_elements && (halo_layers > 0 || n_parts == 1);
  if (keeps_elements) require_elements(mesh.elements.of_tet, mesh.elements.vertices, mesh.tets, n);
  const TetsOfVertices around(halo_layers == 0 ? MeshView{} : MeshView{mesh.points, mesh.tets});
  std::vector<VertexId> local(n, -1);
  for (std::int32_t p = 0; p < n_parts; ++p) {
    MeshPart& part = result[static_cast<std::size_t>(p)];
    part.dimension = mesh.dimension;
    for (const GlobalId t : part.tet_ids) {
      for (const VertexId v : mesh.tets[static_cast<std::size_t>(t)]) {
        VertexId& seen = local[static_cast<std::size_t>(v)];
        if (seen < 0) part.point_ids.push_back(v);
        seen = 0;
      }
    }
    part.n_own_tets = static_cast<std::int64_t>(part.tet_ids.size());
    for (std::int32_t layer = 0; layer < halo_layers; ++layer) add_layer(mesh, around, part);
    if (keeps_elements)
      for_elements(mesh.elements, part, [&](std::size_t, std::span<const VertexId> element) {
        part.point_ids.insert(part.point_ids.end(), element.begin(), element.end());
      });
    sort_unique(part.point_ids);
    const auto owned = [&](GlobalId v) { return owner[static_cast<std::size_t>(v)] == p; };
    const auto middle = std::stable_partition(part.point_ids.begin(), part.point_ids.end(), owned);
    part.n_owned = middle - part.point_ids.begin();
    part.points.reserve(part.point_ids.size());
    for (const GlobalId v : part.point_ids) {
      local[static_cast<std::size_t>(v)] = static_cast<VertexId>(part.points.size());
      part.points.push_back(mesh.points[static_cast<std::size_t>(v)]);
    }
    part.tets.reserve(part.tet_ids.size());
    for (const GlobalId t : part.tet_ids) {
      Tet tet = mesh.tets[static_cast<std::size_t>(t)];
      for (VertexId& v : tet) v = local[static_cast<std::size_t>(v)];
      part.tets.push_back(tet);
    }
    if (keeps_elements) take_elements(mesh.elements, local, part);
    part.lacks_elements = has_elements && !keeps_elements;
    for (const GlobalId v : part.point_ids) local[static_cast<std::size_t>(v)] = -1;
  }
  list_ghosts(result, owner);
  return result;
}

}  // namespace tess::m2m
