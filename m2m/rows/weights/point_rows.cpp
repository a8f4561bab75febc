#include "m2m/rows/weights/point_rows.hpp"

#include <algorithm>

namespace tess::m2m {

Rows<double> linear_rows(std::span<const Tet> tets, std::span<const PointInTet> points) {
  Rows<double> rows;
  rows.begin.reserve(points.size() + 1);
  rows.columns.reserve(4 * points.size());
  rows.weights.reserve(4 * points.size());
  for (const PointInTet& point : points) {
    const Tet& tet = tets[static_cast<std::size_t>(point.tet)];
    const auto corner = std::find(point.weights.begin(), point.weights.end(), 1.0);
    if (corner != point.weights.end()) {
      rows.add(tet[static_cast<std::size_t>(corner - point.weights.begin())], 1.0);
    } else {
      for (std::size_t k = 0; k < 4; ++k)
        if (k == 0 || tet[k] != tet[k - 1] || point.weights[k] != 0)  // a triangle repeats one
          rows.add(tet[k], point.weights[k]);
    }
    rows.end_row();
  }
  return rows;
}

Rows<double> nearest_rows(std::span<const VertexId> vertices) {
  Rows<double> rows;
  for (const VertexId vertex : vertices) {
    if (vertex >= 0) rows.add(vertex, 1.0);
    rows.end_row();
  }
  return rows;
}

}  // namespace tess::m2m
