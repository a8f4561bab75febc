#include "m2m/mesh/workers/scatter.hpp"

#include "m2m/mesh/partition/partition.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "runtime/core/check.hpp"

namespace tess::m2m {
namespace {

/// The values of all fields at the points of a part; a row holds the components of all fields.
std::vector<double> rows_of(const MeshPart& part, const std::vector<Field>& fields,
                            std::size_t n_components) {
  std::vector<double> rows(part.points.size() * n_components);
  std::size_t column = 0;
  for (const Field& field : fields) {
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      const auto vertex = static_cast<std::size_t>(part.point_ids[i]);
      for (std::size_t c = 0; c < field.n_components; ++c)
        rows[i * n_components + column + c] = field.values[vertex * field.n_components + c];
    }
    column += field.n_components;
  }
  return rows;
}

}  // namespace

DistributedMesh scatter(const TetMesh& mesh, const std::vector<Field>& fields, std::int32_t n_parts,
                        PartitionMethod method, std::int32_t halo_layers) {
  DistributedMesh out;
  out.n_parts = n_parts;
  out.halo_layers = halo_layers;
  for (const Field& field : fields) {
    TESS_CHECK(field.values.size() == mesh.n_points() * field.n_components, "field ", field.name,
               ": expected ", mesh.n_points() * field.n_components, " values, got ",
               field.values.size());
    out.n_components += field.n_components;
  }
  std::vector<MeshPart> parts = split(mesh, partition(mesh, n_parts, method), n_parts, halo_layers);
  out.workers = create<Worker>(range(n_parts));
  for (std::int32_t k = 0; k < n_parts; ++k) {
    MeshPart& part = parts[static_cast<std::size_t>(k)];
    std::vector<double> rows = rows_of(part, fields, out.n_components);
    out.workers[{k}].send<&Worker::load>(
        PartLoad{std::move(part), out.n_components, std::move(rows)});
  }
  return out;
}

}  // namespace tess::m2m
