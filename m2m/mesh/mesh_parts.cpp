#include "m2m/mesh_parts.hpp"

#include "m2m/mesh/partition/partition.hpp"

namespace tess::m2m {

std::vector<MeshPart> mesh_parts(const TetMesh& mesh, std::int32_t n_parts, PartitionMethod method,
                                 std::int32_t halo_layers) {
  return split(mesh, partition(mesh, n_parts, method), n_parts, halo_layers);
}

}  // namespace tess::m2m
