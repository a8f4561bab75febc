// A mesh as an array of chares: one Worker for each part. The array is virtualised: any number of
// Workers a PE.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/parallel/worker.hpp"
#include "m2m/partition/partition.hpp"
#include "m2m/partition/split.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

/// A distributed mesh: the proxies to its Workers and what all need to know. A value that can be
/// sent.
struct DistributedMesh {
  ArrayProxy<Worker> workers;
  std::int32_t n_parts = 0;
  std::size_t n_components = 0;  ///< of all fields together
  std::vector<Aabb> boxes{};     ///< of each part's own vertices; lo > hi where it has none

  /// Ends the mesh, between two transfers: its Workers are freed on all PEs. The epoch that runs
  /// waits for that.
  void destroy() const { workers.destroy(); }
};

/// Sends the parts of a mesh, with their rows of the fields, to new Workers, spread evenly over all
/// PEs. Inside an epoch, the mesh is in place when the epoch is done. Partitions by tetrahedra
/// (partition.hpp).
[[nodiscard]] DistributedMesh scatter(const TetMesh& mesh, const std::vector<Field>& fields,
                                      std::int32_t n_parts, PartitionMethod method);

}  // namespace tess::m2m
