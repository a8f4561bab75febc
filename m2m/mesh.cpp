#include "m2m/mesh.hpp"

#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::m2m {

Aabb bounds(const TetMesh& mesh) {
  return box_around(mesh.points);
}

double signed_volume(const TetMesh& mesh, std::size_t tet) {
  const auto point = [&](std::size_t corner) {
    return mesh.points[static_cast<std::size_t>(mesh.tets[tet][corner])];
  };
  const Point o = point(0);
  std::array<Point, 3> e{point(1), point(2), point(3)};
  for (Point& edge : e) {
    for (std::size_t axis = 0; axis < 3; ++axis) edge[axis] -= o[axis];
  }
  return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
          e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
          e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
         6.0;
}

std::string skipped_text(const TetMesh& mesh) {
  std::string out;
  for (const Skipped& skipped : mesh.skipped) {
    if (!out.empty()) out += ", ";
    out += std::to_string(skipped.n_elements) + " " + skipped.type;
  }
  return out;
}

namespace {

void validate_groups(const TetMesh& mesh) {
  std::size_t n_in_blocks = 0;
  for (const Block& block : mesh.blocks) n_in_blocks += block.n_tets;
  if (!mesh.blocks.empty() && n_in_blocks != mesh.n_tets())
    fail(ErrorCode::bad_mesh,
         mesh.name,
         ": its blocks have ",
         n_in_blocks,
         " of ",
         mesh.n_tets(),
         " tetrahedra; give all, or no blocks");
  for (const SideSet& set : mesh.side_sets) {
    for (const Side& side : set.entries) {
      if (side.tet < 0 || side.tet >= static_cast<GlobalId>(mesh.n_tets()) || side.side < 1 ||
          side.side > 4)
        fail(ErrorCode::bad_mesh,
             mesh.name,
             ": side set ",
             set.id,
             " names side ",
             side.side,
             " of tetrahedron ",
             side.tet,
             " (counted from 0) of ",
             mesh.n_tets(),
             "; write the mesh again");
    }
  }
  for (const NodeSet& set : mesh.node_sets) {
    for (const VertexId v : set.entries) {
      if (v < 0 || static_cast<std::size_t>(v) >= mesh.n_points())
        fail(ErrorCode::bad_mesh,
             mesh.name,
             ": node set ",
             set.id,
             " names vertex ",
             v,
             " (counted from 0) of ",
             mesh.n_points(),
             "; write the mesh again");
    }
  }
}

}  // namespace

MeshCensus validate(const TetMesh& mesh) {
  const std::size_t n = mesh.n_points();
  if (mesh.tets.empty()) {
    const std::string others = skipped_text(mesh);
    fail(ErrorCode::bad_mesh,
         mesh.name,
         ": has no tetrahedra",
         others.empty() ? "" : " (but " + others + ")",
         "; give a volume mesh of TET4 elements");
  }
  validate_groups(mesh);
  if (n > static_cast<std::size_t>(std::numeric_limits<VertexId>::max())) {
    fail(ErrorCode::bad_mesh,
         mesh.name,
         ": has ",
         n,
         " vertices; at most 2147483647 fit in one mesh, split it");
  }
  constexpr double largest = 1e100;  // beyond, volumes (cubes of lengths) leave the range of double
  for (std::size_t v = 0; v < n; ++v) {
    const Point& p = mesh.points[v];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(p[axis]) || std::abs(p[axis]) > largest) {
        fail(ErrorCode::bad_mesh,
             mesh.name,
             ": vertex ",
             v,
             " has ",
             "xyz"[axis],
             " = ",
             p[axis],
             "; coordinates must be finite and within 1e100: repair or rescale the mesh");
      }
    }
  }
  std::vector<char> used(n, 0);
  MeshCensus census;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    for (const VertexId v : mesh.tets[t]) {
      if (v < 0 || static_cast<std::size_t>(v) >= n) {
        fail(ErrorCode::bad_mesh,
             mesh.name,
             ": tetrahedron ",
             t,
             " names vertex ",
             v,
             " (counted from 0) of ",
             n,
             " vertices; write the mesh again");
      }
      used[static_cast<std::size_t>(v)] = 1;
    }
    const double volume = signed_volume(mesh, t);
    census.n_flat += volume == 0;
    census.n_inverted += volume < 0;
  }
  census.n_unused = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
  census.bounds = bounds(mesh);
  return census;
}

}  // namespace tess::m2m
