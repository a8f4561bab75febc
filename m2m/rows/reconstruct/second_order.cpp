#include "m2m/rows/reconstruct/second_order.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/rows/reconstruct/gather.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

constexpr ValueRange no_range{std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};

void include(ValueRange& range, double value) {
  if (value < range.low) range.low = value;
  if (value > range.high) range.high = value;
}
void include(ValueRange& range, const ValueRange& other) {
  include(range, other.low);
  include(range, other.high);
}
double clamped(double value, const ValueRange& range) {
  if (value < range.low) return range.low;
  return value > range.high ? range.high : value;
}

/// Relative to corner 0, so an offset of the mesh costs no digit.
Point centroid(const std::array<Point, 4>& c, std::int32_t dimension) {
  Point centre;
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    for (std::size_t i = 1; i <= static_cast<std::size_t>(dimension); ++i) sum += c[i][k] - c[0][k];
    centre[k] = c[0][k] + sum / (dimension + 1);
  }
  return centre;
}

/// From the centroid to the point with these weights.
Point cell_arm(const Weights& weights, const std::array<Point, 4>& corners) {
  Point arm{};
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      arm[k] += (weights[i] - 0.25) * (corners[i][k] - corners[0][k]);
  return arm;
}

}  // namespace

std::array<Point, 4> second_order_arms(const Weights& weights,
                                       const std::array<Point, 4>& corners) {
  std::array<Point, 4> arms{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        arms[i][k] += weights[j] * (corners[j][k] - corners[i][k]);
    for (double& x : arms[i]) x *= weights[i] / 2;
  }
  return arms;
}

void second_order_values(MeshView mesh, std::span<const PointInTet> points,
                         std::span<const double> values, std::span<const Point> gradients,
                         std::size_t n_components, Limit limit,
                         std::span<const ValueRange> patch_ranges, std::span<double> out) {
  TESS_CHECK(out.size() == points.size() * n_components, "expected room for ", points.size(),
             " rows of ", n_components, " components, got ", out.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(points[p].tet)];
    const Weights& weights = points[p].weights;
    const std::array<Point, 4> arms = second_order_arms(weights, corners_of(mesh.points, tet));
    const bool at_vertex = std::find(weights.begin(), weights.end(), 1.0) != weights.end();
    for (std::size_t c = 0; c < n_components; ++c) {
      double value = interpolated(weights, tet, values.data() + c, n_components);
      double& to = out[p * n_components + c];
      to = value;
      if (at_vertex) continue;
      ValueRange range = no_range;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = static_cast<std::size_t>(tet[i]) * n_components + c;
        if (weights[i] != 0) value += dot(arms[i], gradients[at]);  // its gradient may be NaN
        if (limit == Limit::tetrahedron) include(range, values[at]);
        if (limit == Limit::patch) include(range, patch_ranges[at]);
      }
      to = limit == Limit::none ? value : clamped(value, range);
    }
  }
}

Rows<double> second_order_rows(MeshView mesh, std::span<const PointInTet> points,
                               const Rows<Point>& gradients) {
  Rows<double> rows;
  Gather columns(mesh.points.size());
  std::vector<double> sum(mesh.points.size(), 0.0);
  for (const PointInTet& point : points) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(point.tet)];
    const auto corner = std::find(point.weights.begin(), point.weights.end(), 1.0);
    if (corner != point.weights.end()) {
      rows.add(tet[static_cast<std::size_t>(corner - point.weights.begin())], 1.0);
      rows.end_row();
      continue;
    }
    const std::array<Point, 4> arms =
        second_order_arms(point.weights, corners_of(mesh.points, tet));
    columns.clear();
    for (std::size_t i = 0; i < 4; ++i) {
      const auto vertex = static_cast<std::size_t>(tet[i]);
      columns.add(tet[i]);
      sum[vertex] += point.weights[i];
      const auto patch = gradients.columns_of(vertex);
      const auto weights = gradients.weights_of(vertex);
      for (std::size_t k = 0; k < patch.size(); ++k) {
        columns.add(patch[k]);
        sum[static_cast<std::size_t>(patch[k])] += dot(arms[i], weights[k]);
      }
    }
    for (const std::int32_t v : columns.found) {
      rows.add(v, sum[static_cast<std::size_t>(v)]);
      sum[static_cast<std::size_t>(v)] = 0;
    }
    rows.end_row();
  }
  return rows;
}

std::vector<ValueRange> vertex_ranges(MeshView mesh, std::span<const double> values,
                                      std::size_t n_components) {
  std::vector<ValueRange> ranges(mesh.points.size() * n_components, no_range);
  for (const Tet& tet : mesh.tets) {
    for (std::size_t c = 0; c < n_components; ++c) {
      ValueRange range = no_range;
      for (const VertexId v : tet)
        include(range, values[static_cast<std::size_t>(v) * n_components + c]);
      for (const VertexId v : tet)
        include(ranges[static_cast<std::size_t>(v) * n_components + c], range);
    }
  }
  return ranges;
}

std::vector<Point> centroids(MeshView mesh) {
  std::vector<Point> centres;
  centres.reserve(mesh.tets.size());
  for (const Tet& tet : mesh.tets)
    centres.push_back(centroid(corners_of(mesh.points, tet), mesh.dimension));
  return centres;
}

void cell_values(MeshView mesh, std::span<const PointInTet> points, std::span<const double> values,
                 std::span<const Point> gradients, std::size_t n_components,
                 std::span<double> out) {
  TESS_CHECK(out.size() == points.size() * n_components, "expected room for ", points.size(),
             " rows of ", n_components, " components, got ", out.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto tet = static_cast<std::size_t>(points[p].tet);
    const Point arm = cell_arm(points[p].weights, corners_of(mesh.points, mesh.tets[tet]));
    for (std::size_t c = 0; c < n_components; ++c) {
      double& to = out[p * n_components + c];
      to = values[tet * n_components + c];
      if (!gradients.empty()) to += dot(arm, gradients[tet * n_components + c]);
    }
  }
}

Rows<double> cell_rows(MeshView mesh, std::span<const PointInTet> points,
                       const Rows<Point>& gradients) {
  Rows<double> rows;
  for (const PointInTet& point : points) {
    const auto tet = static_cast<std::size_t>(point.tet);
    if (gradients.n_rows() == 0) {
      rows.add(point.tet, 1.0);
    } else {
      const Point arm = cell_arm(point.weights, corners_of(mesh.points, mesh.tets[tet]));
      const auto columns = gradients.columns_of(tet);
      const auto weights = gradients.weights_of(tet);
      if (columns.empty()) rows.add(point.tet, 1.0);
      for (std::size_t k = 0; k < columns.size(); ++k)
        rows.add(columns[k], dot(arm, weights[k]) + (columns[k] == point.tet ? 1.0 : 0.0));
    }
    rows.end_row();
  }
  return rows;
}

std::vector<double> corner_values(MeshView mesh, std::span<const double> values,
                                  std::span<const Point> gradients, std::size_t n_components) {
  std::vector<PointInTet> points;
  points.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      points.push_back({static_cast<std::int32_t>(t), {}});
      points.back().weights[corner] = 1;
    }
  }
  std::vector<double> out(points.size() * n_components);
  cell_values(mesh, points, values, gradients, n_components, out);
  return out;
}

void limit_cell_gradients(MeshView mesh, std::span<const double> values, std::size_t n_components,
                          std::span<Point> gradients) {
  // The range over the tetrahedra around each vertex.
  std::vector<ValueRange> ranges(mesh.points.size() * n_components, no_range);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const VertexId v : mesh.tets[t])
      for (std::size_t c = 0; c < n_components; ++c)
        include(ranges[static_cast<std::size_t>(v) * n_components + c],
                values[t * n_components + c]);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::array<Point, 4> corners = corners_of(mesh.points, mesh.tets[t]);
    const Point centre = centroid(corners, mesh.dimension);
    for (std::size_t c = 0; c < n_components; ++c) {
      const double own = values[t * n_components + c];
      Point& gradient = gradients[t * n_components + c];
      ValueRange range = no_range;
      for (const VertexId v : mesh.tets[t])
        include(range, ranges[static_cast<std::size_t>(v) * n_components + c]);
      double factor = 1;
      for (const Point& corner : corners) {
        const double change = dot(gradient, difference(corner, centre));
        if (change > 0) factor = std::min(factor, (range.high - own) / change);
        if (change < 0) factor = std::min(factor, (range.low - own) / change);
      }
      for (double& x : gradient) x *= std::max(factor, 0.0);
    }
  }
}

}  // namespace tess::m2m
