// A distributed mesh: an array of Workers, one per part. The number of parts is independent of the
// number of PEs.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/mesh/workers/worker.hpp"
#include "m2m/partition_method.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

/// A handle to a distributed mesh. It can be copied and sent.
struct DistributedMesh {
  ArrayProxy<Worker> workers;
  std::int32_t n_parts = 0;
  std::size_t n_components = 0;  ///< of all fields together
  std::int32_t halo_layers = 0;
  std::int32_t dimension = 3;  ///< of its cells: TetMesh::dimension

  /// Frees the Workers on all PEs. No transfer may be running. The enclosing epoch includes this.
  void destroy() const { workers.destroy(); }
};

/// Partitions the mesh by tetrahedra, creates the Workers, spread evenly over all PEs, and sends
/// each its part with the rows of the fields. The mesh is in place when the enclosing epoch is
/// done. Some kinds need halo layers around sources or targets
/// (transfer_kind.hpp). The errors are those of mesh_parts().
[[nodiscard]] DistributedMesh scatter(const TetMesh& mesh, const std::vector<Field>& fields,
                                      std::int32_t n_parts, PartitionMethod method,
                                      std::int32_t halo_layers = 0);

/// What couplings see of values in tetrahedra.
enum class CellForm : std::uint8_t {
  points,    ///< values at the centroids, without a mesh
  constant,  ///< Centring::cells
  linear,    ///< Centring::corners
  limited,   ///< the same, with CornerLimit::neighbours
};

/// Scatters a mesh with fields in tetrahedra, and the halo that the form needs.
[[nodiscard]] DistributedMesh scatter_cells(const TetMesh& mesh, const std::vector<Field>& fields,
                                            std::int32_t n_parts, PartitionMethod method,
                                            CellForm form);

}  // namespace tess::m2m
