// The boundary of an overset mesh: walls, which cut holes into other meshes, and the outer
// boundary, which receives values from them. Boundary faces are those of one tetrahedron only.
#pragma once

#include "m2m/overset/symmetry.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

struct OversetBoundary {
  /// Indices into the points of the mesh; the normals point out of the mesh, into the body.
  std::vector<std::array<VertexId, 3>> wall;
  /// Per point of the mesh: 1 on the outer boundary, otherwise 0.
  std::vector<std::uint8_t> on_outer;
};

/// The wall is the side set of the given name. Without a name it is every connected part of the
/// boundary that encloses a cavity, as the inner sphere of a spherical shell does. The rest is
/// outer boundary. Faces in planes of symmetry are neither, unless the side set has them; a cavity
/// may be open to them. Takes O(n log n) for n tetrahedra. Throws Error (bad_argument) if the mesh
/// has no such side set.
[[nodiscard]] OversetBoundary overset_boundary(const TetMesh& mesh, const std::string& wall = {},
                                               std::span<const SymmetryPlane> symmetry = {});

}  // namespace tess::m2m
