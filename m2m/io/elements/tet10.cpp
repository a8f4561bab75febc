#include "m2m/io/elements/tet10.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// The corners of the edge whose middle is node 4 + k.
constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

/// The barycentric coordinates of a node.
Weights node(std::size_t k) {
  Weights at{};
  if (k < 4) {
    at[k] = 1;
  } else {
    at[edges[k - 4][0]] = at[edges[k - 4][1]] = 0.5;
  }
  return at;
}

/// Derivatives of the shape functions by L_1, L_2, L_3, with L_0 = 1 - L_1 - L_2 - L_3.
std::array<Point, 10> derivatives(const Weights& l) {
  std::array<Weights, 10> by{};  // by all four coordinates
  for (std::size_t i = 0; i < 4; ++i) by[i][i] = 4 * l[i] - 1;
  for (std::size_t e = 0; e < 6; ++e) {
    by[4 + e][edges[e][0]] = 4 * l[edges[e][1]];
    by[4 + e][edges[e][1]] = 4 * l[edges[e][0]];
  }
  std::array<Point, 10> out;
  for (std::size_t n = 0; n < 10; ++n)
    for (std::size_t k = 0; k < 3; ++k) out[n][k] = by[n][k + 1] - by[n][0];
  return out;
}

double largest(const Point& p) {
  return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
}

}  // namespace

Tet10Weights tet10_shape(const Weights& l) {
  Tet10Weights n;
  for (std::size_t i = 0; i < 4; ++i) n[i] = l[i] * (2 * l[i] - 1);
  for (std::size_t e = 0; e < 6; ++e) n[4 + e] = 4 * l[edges[e][0]] * l[edges[e][1]];
  return n;
}

std::optional<Weights> tet10_invert(const Point& p, const Tet10Points& nodes, const Weights& start,
                                    double slack) {
  // Relative to the point, in the unit of the element: neither place nor scale costs a digit.
  Tet10Points x;
  double size = 0;
  for (std::size_t n = 0; n < 10; ++n) {
    x[n] = difference(nodes[n], p);
    size = std::max(size, largest(difference(nodes[n], nodes[0])));
  }
  if (!(size > 0)) return std::nullopt;
  for (Point& at : x)
    for (double& c : at) c /= size;
  Weights l = start;
  double orientation = 0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Tet10Weights shape = tet10_shape(l);
    Point error{};
    for (std::size_t n = 0; n < 10; ++n)
      for (std::size_t k = 0; k < 3; ++k) error[k] += shape[n] * x[n][k];
    const std::array<Point, 10> by = derivatives(l);
    std::array<Point, 3> column{};  // derivative of the point by L_1, L_2, L_3
    for (std::size_t n = 0; n < 10; ++n)
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) column[k][axis] += by[n][k] * x[n][axis];
    const double determinant = dot(column[0], cross(column[1], column[2]));
    if (orientation == 0) orientation = determinant;
    if (!(determinant * orientation > 0)) return std::nullopt;  // folds over
    const Point step{-dot(error, cross(column[1], column[2])) / determinant,
                     -dot(column[0], cross(error, column[2])) / determinant,
                     -dot(column[0], cross(column[1], error)) / determinant};
    const double length = largest(step);
    if (!(length < 1e3)) return std::nullopt;
    const double damping = length > 0.5 ? 0.5 / length : 1;
    for (std::size_t k = 0; k < 3; ++k) l[k + 1] += damping * step[k];
    l[0] = 1 - (l[1] + l[2] + l[3]);
    if (length < 1e-9 && largest(error) < 1e-12) {  // quadratic convergence: the step was the last
      if (*std::min_element(l.begin(), l.end()) < -slack) return std::nullopt;
      return l;
    }
  }
  return std::nullopt;
}

Tet10 tet10_of(std::span<const Tet, 8> t) {
  return {t[0][0], t[1][1], t[2][2], t[3][3], t[0][1], t[1][2], t[0][2], t[0][3], t[1][3], t[2][3]};
}

Rows<double> tet10_rows(MeshView mesh, std::span<const PointInTet> points,
                        std::span<const Point> positions, std::size_t& n_linear) {
  TESS_CHECK(mesh.tets.size() % 8 == 0, "expected eight tetrahedra per element, got ",
             mesh.tets.size());
  TESS_CHECK(points.size() == positions.size(), "expected ", points.size(), " positions, got ",
             positions.size());
  Rows<double> rows;
  n_linear = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto tet = static_cast<std::size_t>(points[i].tet);
    const Tet& small = mesh.tets[tet];
    const Tet10 element = tet10_of(mesh.tets.subspan(tet / 8 * 8).first<8>());
    // The start: the coordinates of the point, were the element straight.
    Weights start{};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const auto place = std::find(element.begin(), element.end(), small[corner]);
      const Weights at = node(static_cast<std::size_t>(place - element.begin()));
      for (std::size_t k = 0; k < 4; ++k) start[k] += points[i].weights[corner] * at[k];
    }
    Tet10Points nodes;
    for (std::size_t n = 0; n < 10; ++n)
      nodes[n] = mesh.points[static_cast<std::size_t>(element[n])];
    const bool at_vertex = std::find(points[i].weights.begin(), points[i].weights.end(), 1.0) !=
                           points[i].weights.end();
    std::optional<Weights> found;
    if (!at_vertex) found = tet10_invert(positions[i], nodes, start);
    if (found) {
      const Tet10Weights weights = tet10_shape(*found);
      for (std::size_t n = 0; n < 10; ++n) rows.add(element[n], weights[n]);
    } else {
      for (std::size_t corner = 0; corner < 4; ++corner)
        if (!at_vertex || points[i].weights[corner] == 1)
          rows.add(small[corner], points[i].weights[corner]);
      n_linear += at_vertex ? 0 : 1;
    }
    rows.end_row();
  }
  return rows;
}

}  // namespace tess::m2m
