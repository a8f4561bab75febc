#include "m2m/mesh/workers/scatter.hpp"

#include "m2m/mesh/partition/partition.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "m2m/rows/reconstruct/second_order.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <utility>

namespace tess::m2m {
namespace {

/// The rows of some vertices or tetrahedra; a row holds the components of all fields.
std::vector<double> rows_of(std::span<const GlobalId> ids, const std::vector<Field>& fields,
                            std::size_t n_components) {
  std::vector<double> rows(ids.size() * n_components);
  auto to = rows.begin();
  for (const GlobalId id : ids)
    for (const Field& field : fields)
      to = std::copy_n(field.values.data() + static_cast<std::size_t>(id) * field.n_components,
                       field.n_components, to);
  return rows;
}

/// Cuts the mesh and sends each part to its Worker. `prepare` changes what a part is loaded with.
template <class Prepare>
DistributedMesh send_parts(const TetMesh& mesh, const std::vector<Field>& fields,
                           std::int32_t n_parts, PartitionMethod method, std::int32_t halo_layers,
                           Centring centring, const Prepare& prepare) {
  DistributedMesh out{{}, n_parts, 0, halo_layers, mesh.dimension};
  const bool has_nodes = centring == Centring::nodes;
  const std::size_t n_rows = has_nodes ? mesh.n_points() : mesh.n_tets();
  for (const Field& field : fields) {
    TESS_CHECK(field.values.size() == n_rows * field.n_components, "field ", field.name,
               ": expected ", n_rows * field.n_components, " values, got ", field.values.size());
    out.n_components += field.n_components;
  }
  std::vector<MeshPart> parts = split(mesh, partition(mesh, n_parts, method), n_parts, halo_layers);
  out.workers = create<Worker>(range(n_parts));
  for (std::int32_t k = 0; k < n_parts; ++k) {
    PartLoad load{std::move(parts[static_cast<std::size_t>(k)]), out.n_components, {}, centring};
    const MeshPart& part = load.part;
    load.values = rows_of(has_nodes ? part.point_ids : part.tet_ids, fields, out.n_components);
    prepare(load);
    out.workers[{k}].send<&Worker::load>(std::move(load));
  }
  return out;
}

/// The centroids of a part's own tetrahedra in place of the part.
void show_as_points(PartLoad& load) {
  const MeshView mesh = view_of(load.part);
  MeshPart cloud;
  MeshView own{mesh.points, mesh.own_tets()};
  own.dimension = mesh.dimension;
  cloud.points = centroids(own);
  cloud.n_owned = load.part.n_own_tets;
  cloud.point_ids = std::move(load.part.tet_ids);
  load.part = std::move(cloud);
  load.centring = Centring::nodes;
}

}  // namespace

DistributedMesh scatter(const TetMesh& mesh, const std::vector<Field>& fields, std::int32_t n_parts,
                        PartitionMethod method, std::int32_t halo_layers) {
  return send_parts(mesh, fields, n_parts, method, halo_layers, Centring::nodes,
                    [](const PartLoad&) {});
}

DistributedMesh scatter_cells(const TetMesh& mesh, const std::vector<Field>& fields,
                              std::int32_t n_parts, PartitionMethod method, CellForm form) {
  const bool is_split = !mesh.element_of_tet.empty();
  const bool has_gradients = form >= CellForm::linear;
  const auto prepare = [&](PartLoad& load) {
    load.part.ghosts.clear();  // only vertices have ghosts
    if (form == CellForm::points) show_as_points(load);
    if (!has_gradients) return;
    load.elements = load.part.tet_ids;
    if (is_split)
      for (GlobalId& id : load.elements) id = mesh.element_of_tet[static_cast<std::size_t>(id)];
    load.limit = form == CellForm::limited ? CornerLimit::neighbours : CornerLimit::none;
  };
  return send_parts(mesh, fields, n_parts, method,
                    has_gradients ? element_halo_layers(is_split) : 0,
                    has_gradients ? Centring::corners : Centring::cells, prepare);
}

}  // namespace tess::m2m
