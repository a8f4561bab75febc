#include "m2m/mesh/workers/cell_worker.hpp"

#include "m2m/rows/reconstruct/second_order.hpp"

#include <utility>

namespace tess::m2m {

void CellWorker::load(CellLoad load) {
  part_ = std::move(load.part);
  n_components_ = load.n_components;
  values_ = std::move(load.values);
  const MeshView mesh = view_of(part_);
  if (load.form != CellForm::constant)
    values_ = element_corners(
        mesh, load.elements, values_, n_components_,
        load.form == CellForm::limited ? CornerLimit::neighbours : CornerLimit::none);
  as_points_ = load.as_points;
  if (!as_points_) return;
  centroids_ = centroids({mesh.points, mesh.own_tets()});
  values_.resize(centroids_.size() * n_components_);  // without the halo
}

MeshView CellWorker::mesh_view() const {
  const MeshView mesh = view_of(part_);
  if (!as_points_) return mesh;
  return {centroids_, {}, mesh.tet_ids.first(centroids_.size()), {}, mesh.n_own_tets};
}

std::span<double> CellWorker::result() {
  return std::span(values_).first(static_cast<std::size_t>(part_.n_own_tets) * n_components_);
}

void CellWorker::gather(CouplingId coupling, const Callback<Outcome>& target) {
  const std::span<const Status> status = this->status(coupling);
  const std::span<const double> values = result();
  Outcome outcome{{part_.tet_ids.begin(), part_.tet_ids.begin() + part_.n_own_tets},
                  {status.begin(), status.end()},
                  {values.begin(), values.end()},
                  {}};
  contribute(JoinOutcomes{}, std::move(outcome), target);
}

}  // namespace tess::m2m
