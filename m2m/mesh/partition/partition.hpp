// Cuts a mesh into parts by the centroids of its tetrahedra. One process partitions the whole mesh
// (Zoltan on MPI_COMM_SELF). So the parts depend only on the mesh, the method and the
// number of parts, not on the number of processes.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/partition_method.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

/// Returns the part (0 to n_parts - 1) of every tetrahedron. Some parts are empty if there are more
/// parts than tetrahedra. Zoltan (all
/// methods but curve) needs MPI: if MPI is not initialised, this call initialises it as
/// a singleton, and it is finalised at exit. Any thread may call; calls in one process take turns.
/// Throws Error (bad_argument) for fewer than one part, (environment) if Zoltan fails.
[[nodiscard]] std::vector<std::int32_t> partition(const TetMesh& mesh, std::int32_t n_parts,
                                                  PartitionMethod method);

}  // namespace tess::m2m
