// Cuts a mesh into parts by the centroids of its tetrahedra, through Zoltan. Done by one process
// for the whole mesh (on MPI_COMM_SELF), so that the parts depend on the mesh, the method and the
// count alone: never on how many processes run.
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

enum class PartitionMethod {
  rcb,  ///< recursive coordinate bisection
  hsfc  ///< Hilbert space-filling curve
};
/// "rcb" or "hsfc"; throws Error (bad_argument) otherwise.
[[nodiscard]] PartitionMethod parse_partition_method(const std::string& name);

/// The part (0 to n_parts - 1) of every tetrahedron; some parts are empty where there are more
/// parts than tetrahedra. Zoltan needs MPI: where it has not been initialised, this call does so
/// (as a singleton), and it is finalised at exit. Any thread may call it; calls of one process take
/// turns. Throws Error (bad_argument) on no part, (environment) where Zoltan fails.
[[nodiscard]] std::vector<std::int32_t> partition(const TetMesh& mesh, std::int32_t n_parts,
                                                  PartitionMethod method);

}  // namespace tess::m2m
