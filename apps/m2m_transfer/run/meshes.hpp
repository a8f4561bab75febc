// The meshes of a run in the machine: handles to place, move and gather them.
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "m2m/transfer.hpp"
#include "runtime/runtime.hpp"

#include <vector>

namespace m2m_transfer {

/// The vertices of a mesh in global order.
struct Gathered {
  std::vector<Status> status;
  std::vector<std::vector<double>> values;  ///< per field
};

/// Distributes the meshes; each gets the halo that the kind needs.
TaskOf<std::vector<DistributedMesh>> place(const Problem& problem);

/// Gathers a mesh of so many vertices on this PE. All fields have one component.
TaskOf<Gathered> gather(const DistributedMesh& mesh, std::size_t n_vertices);

Task destroy(std::vector<DistributedMesh>& meshes);

[[nodiscard]] inline double seconds_since(Time start) {
  return seconds(now() - start);
}

}  // namespace m2m_transfer
