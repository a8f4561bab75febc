#include "m2m/rows/weights/native_rows.hpp"

#include "m2m/rows/interpolate/native_element.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace tess::m2m {
namespace {

/// The point is at this place, were the element affine.
Point start_of(const Tet& tet, const Weights& weights, std::span<const VertexId> element) {
  Point start{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const auto k = std::ranges::find(element, tet[corner]) - element.begin();
    const Point r = reference_vertex(element.size(), static_cast<std::size_t>(k));
    for (std::size_t axis = 0; axis < 3; ++axis) start[axis] += weights[corner] * r[axis];
  }
  return start;
}

}  // namespace

void add_native_row(const MeshView& mesh, const NativePoint& point, Rows<double>& rows,
                    std::uint64_t& n_linear) {
  const auto tet = static_cast<std::size_t>(point.in.tet);
  const std::int64_t begin = mesh.element_of_tet.empty() ? -1 : mesh.element_of_tet[tet];
  if (begin >= 0 && std::ranges::find(point.in.weights, 1.0) == point.in.weights.end()) {
    const auto element = vertices_of_element(mesh.element_vertices, begin);
    std::array<Point, most_native_vertices> corners;
    for (std::size_t k = 0; k < element.size(); ++k)
      corners[k] = mesh.points[static_cast<std::size_t>(element[k])];
    const std::optional<Point> r = invert_element(
        point.at, std::span(corners).first(element.size()),
        start_of(mesh.tets[tet], point.in.weights, element), point.is_snapped ? 1e-9 : 0.1);
    if (r) {
      const ShapeFunctions shape = shape_functions(element.size(), *r);
      for (std::size_t k = 0; k < element.size(); ++k) rows.add(element[k], shape.values[k]);
    } else if (!point.is_snapped) {
      ++n_linear;
    }
  }
  rows.end_row();
}

}  // namespace tess::m2m
