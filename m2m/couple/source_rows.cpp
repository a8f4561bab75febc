#include "m2m/couple/source_side.hpp"
#include "m2m/rows/reconstruct/second_order.hpp"
#include "m2m/rows/weights/point_rows.hpp"

namespace tess::m2m {

Rows<double> SourceSide::rows_of(const MeshView& mesh, std::span<const Donor> donors) const {
  std::vector<Tet> tets;
  std::vector<PointInTet> points;
  for (const Donor& donor : donors) {
    points.push_back({static_cast<std::int32_t>(tets.size()), donor.weights});
    tets.push_back(donor.vertices);
  }
  if (setup.kind != TransferKind::second_order) return linear_rows(tets, points);
  Rows<Point> gradients;  // one per point of the piece; empty where no donor needs it
  std::size_t next = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (next < gradient_vertices_.size() && gradient_vertices_[next] == static_cast<VertexId>(v)) {
      const auto columns = gradient_rows_.columns_of(next);
      const auto weights = gradient_rows_.weights_of(next);
      for (std::size_t k = 0; k < columns.size(); ++k) gradients.add(columns[k], weights[k]);
      ++next;
    }
    gradients.end_row();
  }
  return second_order_rows({mesh.points, tets}, points, gradients);
}

}  // namespace tess::m2m
