// A mesh that does not conform: a coarse box next to a fine one. Vertices of the fine box lie on
// faces and edges of the coarse box, whose tetrahedra come first. The last tetrahedron has a vertex
// inside another one.
#pragma once

#include "m2m/kuhn.hpp"

namespace tess::test {

inline m2m::TetMesh non_conforming_mesh() {
  m2m::TetMesh mesh = m2m::kuhn_mesh({2});
  mesh.name = "non-conforming";
  m2m::TetMesh fine = m2m::kuhn_mesh({6});
  for (m2m::Point& p : fine.points) p[0] += 1;
  const auto n = static_cast<m2m::VertexId>(mesh.n_points());
  mesh.points.insert(mesh.points.end(), fine.points.begin(), fine.points.end());
  for (m2m::Tet tet : fine.tets) {
    for (m2m::VertexId& v : tet) v += n;
    mesh.tets.push_back(tet);
  }
  const m2m::Tet first = mesh.tets.front();
  m2m::Point inside{};
  for (const m2m::VertexId v : first)
    for (std::size_t axis = 0; axis < 3; ++axis)
      inside[axis] += 0.25 * mesh.points[static_cast<std::size_t>(v)][axis];
  mesh.points.push_back(inside);
  mesh.tets.push_back(
      {first[0], first[1], first[2], static_cast<m2m::VertexId>(mesh.n_points() - 1)});
  return mesh;
}

}  // namespace tess::test
