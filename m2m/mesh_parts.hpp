// Cuts a mesh into parts for an application's own chares (coupling.hpp).
#pragma once

#include "m2m/mesh/partition/split.hpp"
#include "m2m/partition_method.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

/// One part per chare, with so many layers of tetrahedra of other parts around its own. Depends only
/// on the mesh and the arguments. Throws Error (bad_argument, environment) if the mesh cannot be cut,
/// (bad_mesh) for a corner that does not exist or a coordinate that is not finite.
[[nodiscard]] std::vector<MeshPart> mesh_parts(const TetMesh& mesh, std::int32_t n_parts,
                                               PartitionMethod method,
                                               std::int32_t halo_layers = 0);

}  // namespace tess::m2m
