#include "m2m/rows/reconstruct/gradients.hpp"

#include "m2m/rows/reconstruct/gather.hpp"
#include "m2m/rows/reconstruct/gradient_fit.hpp"
#include "m2m/rows/reconstruct/second_order.hpp"
#include "m2m/rows/weights/tets_of_vertices.hpp"

#include <algorithm>
#include <numeric>

namespace tess::m2m {
namespace {

std::vector<std::int32_t> all_of(std::size_t n) {
  std::vector<std::int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void sort_by_id(std::span<std::int32_t> items, std::span<const GlobalId> ids) {
  if (ids.empty()) return std::sort(items.begin(), items.end());
  std::sort(items.begin(), items.end(), [&](std::int32_t a, std::int32_t b) {
    return ids[static_cast<std::size_t>(a)] < ids[static_cast<std::size_t>(b)];
  });
}

/// Fits rows for centres among points, given their neighbours.
class RowFitter {
 public:
  explicit RowFitter(std::span<const Point> points) : points_(points) {}

  /// Returns how well the neighbours determine the polynomial.
  double fit(std::int32_t centre, std::span<const std::int32_t> neighbours, FitDegree degree) {
    const Point& from = points_[static_cast<std::size_t>(centre)];
    offsets_.clear();
    for (const std::int32_t j : neighbours) {
      offsets_.push_back(difference(points_[static_cast<std::size_t>(j)], from));
    }
    return fit_.compute(offsets_, degree, rounding_at(from));
  }

  /// Appends the row: differences u_j - u_centre become a weight of the centre, which comes first.
  void append(std::int32_t centre, std::span<const std::int32_t> neighbours,
              Rows<Point>& rows) const {
    Point own{};
    for (const Point& weight : fit_.weights())
      for (std::size_t k = 0; k < 3; ++k) own[k] -= weight[k];
    if (!neighbours.empty()) rows.add(centre, own);
    for (std::size_t j = 0; j < neighbours.size(); ++j) rows.add(neighbours[j], fit_.weights()[j]);
    rows.end_row();
  }

 private:
  std::span<const Point> points_;
  std::vector<Point> offsets_;
  GradientFit fit_;
};

}  // namespace

Rows<Point> gradient_rows(MeshView mesh, std::span<const GlobalId> ids,
                          std::span<const VertexId> vertices) {
  const TetsOfVertices around(mesh);
  Gather patch(mesh.points.size());
  RowFitter fitter(mesh.points);
  Rows<Point> rows;
  const auto add_neighbours = [&](VertexId of) {
    for (const std::int32_t t : around[of])
      for (const VertexId v : mesh.tets[static_cast<std::size_t>(t)]) patch.add(v);
  };
  for (const VertexId vertex : vertices) {
    patch.clear();
    patch.add(vertex);
    for (std::size_t ring = 1; ring <= 2; ++ring) {
      const std::size_t n_inner = patch.found.size();
      for (std::size_t j = 0; j < n_inner; ++j) add_neighbours(patch.found[j]);
      const auto neighbours = std::span(patch.found).subspan(1);
      sort_by_id(neighbours, ids);
      if (fitter.fit(vertex, neighbours, FitDegree::quadratic) > GradientFit::well_determined)
        break;
    }
    fitter.append(vertex, std::span(patch.found).subspan(1), rows);
  }
  return rows;
}

Rows<Point> gradient_rows(MeshView mesh) {
  return gradient_rows(mesh, {}, all_of(mesh.points.size()));
}

Rows<Point> cell_gradient_rows(MeshView mesh, std::span<const GlobalId> ids,
                               std::span<const std::int32_t> cells) {
  const TetsOfVertices around(mesh);
  const std::vector<Point> centres = centroids(mesh);
  Gather patch(mesh.tets.size());
  RowFitter fitter(centres);
  Rows<Point> rows;
  for (const std::int32_t cell : cells) {
    patch.clear();
    patch.add(cell);
    for (const VertexId v : mesh.tets[static_cast<std::size_t>(cell)])
      for (const std::int32_t t : around[v]) patch.add(t);
    const auto neighbours = std::span(patch.found).subspan(1);
    sort_by_id(neighbours, ids);
    fitter.fit(cell, neighbours, FitDegree::linear);
    fitter.append(cell, neighbours, rows);
  }
  return rows;
}

Rows<Point> cell_gradient_rows(MeshView mesh) {
  return cell_gradient_rows(mesh, {}, all_of(mesh.tets.size()));
}

}  // namespace tess::m2m
