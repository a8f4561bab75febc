#include "apps/m2m_transfer/run/meshes.hpp"

#include "m2m/placement.hpp"
#include "runtime/more/when.hpp"

#include <string>
#include <utility>
#include <vector>

namespace m2m_transfer {

namespace {

/// All PEs read and cut together, and evaluate the fields where the points are.
TaskOf<std::vector<DistributedMesh>> place_together(const Problem& problem) {
  std::vector<TaskOf<PlacedMesh>> tasks;
  for (std::size_t m = 0; m < problem.meshes.size(); ++m) {
    const PlaceOptions options{problem.chares(), halo_for(problem.kind, m, problem.pairs),
                               problem.kind == tess::m2m::TransferKind::native};
    std::vector<FormulaField> fields;
    for (const std::string& name : problem.field_names)
      fields.push_back({needs_values(m, problem.pairs) ? name : "0", problem.domain});
    const RunMesh& mesh = problem.meshes[m];
    tasks.push_back(mesh.mesh ? tess::m2m::place(&*mesh.mesh, options, fields)
                              : tess::m2m::place(mesh.name, options, fields));
  }
  const std::vector<PlacedMesh> placed = co_await tess::when_all(std::move(tasks));
  std::vector<DistributedMesh> meshes;
  for (const PlacedMesh& mesh : placed) meshes.push_back(mesh.mesh);
  co_return meshes;
}

}  // namespace

TaskOf<std::vector<DistributedMesh>> place(const Problem& problem) {
  if (problem.partition == PartitionMethod::curve) co_return co_await place_together(problem);
  std::vector<DistributedMesh> meshes;
  co_await epoch([&] {
    for (std::size_t m = 0; m < problem.meshes.size(); ++m)
      meshes.push_back(scatter(*problem.meshes[m].mesh, problem.meshes[m].fields, problem.chares(),
                               problem.partition, halo_for(problem.kind, m, problem.pairs)));
  });
  co_return meshes;
}

TaskOf<Gathered> gather(const DistributedMesh& mesh, std::size_t n_vertices) {
  const Outcome all = co_await mesh.workers.reduce<&Worker::gather>();
  const std::size_t n_fields = mesh.n_components;
  Gathered out;
  out.status.assign(n_vertices, Status::outside);
  out.values.assign(n_fields, std::vector<double>(n_vertices));
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(all.points[i]);
    out.status[vertex] = all.status[i];
    for (std::size_t f = 0; f < n_fields; ++f) out.values[f][vertex] = all.values[i * n_fields + f];
  }
  co_return out;
}

Task destroy(std::vector<DistributedMesh>& meshes) {
  co_await epoch([&] {
    for (const DistributedMesh& mesh : meshes) mesh.destroy();
  });
  meshes.clear();
}

}  // namespace m2m_transfer
