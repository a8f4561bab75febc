#include "m2m/rows/interpolate/native_element.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

/// In halves of the edge; eight-node hexahedra and bases of pyramids have the first ones.
constexpr std::int8_t cube_vertices[27][3] = {
    {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
    {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 1},
    {2, 2, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {1, 1, 1},
    {1, 1, 0}, {1, 1, 2}, {0, 1, 1}, {2, 1, 1}, {1, 0, 1}, {1, 2, 1}};
/// The corners of the edge of a tetrahedron whose middle is vertex 4 + k.
constexpr std::size_t tet_edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
/// Of barycentric coordinates L_0, L_1, … by L_1, L_2, …
constexpr double by_axis(std::size_t l, std::size_t axis) {
  return l == 0 ? -1 : l == axis + 1 ? 1 : 0;
}

/// On an edge with vertices at 0 and 1, and in the middle if it is quadratic: the shape function of
/// the vertex at `half` / 2, and its derivative.
std::array<double, 2> on_edge(int half, double x, bool is_quadratic) {
  if (!is_quadratic) return half == 0 ? std::array{1 - x, -1.0} : std::array{x, 1.0};
  if (half == 1) return {4 * x * (1 - x), 4 - 8 * x};
  return half == 0 ? std::array{(1 - x) * (1 - 2 * x), 4 * x - 3}
                   : std::array{x * (2 * x - 1), 4 * x - 1};
}

void set_hexahedron(std::size_t n_vertices, const Point& r, ShapeFunctions& n) {
  for (std::size_t k = 0; k < n_vertices; ++k) {
    Point f{}, slope{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [value, by] = on_edge(cube_vertices[k][axis], r[axis], n_vertices == 27);
      f[axis] = value;
      slope[axis] = by;
    }
    n.values[k] = f[0] * f[1] * f[2];
    n.gradients[k] = {slope[0] * f[1] * f[2], f[0] * slope[1] * f[2], f[0] * f[1] * slope[2]};
  }
}

void set_wedge(const Point& r, ShapeFunctions& n) {
  const Point l{1 - (r[0] + r[1]), r[0], r[1]};
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t corner = k % 3;
    const double height = k < 3 ? 1 - r[2] : r[2];
    n.values[k] = l[corner] * height;
    n.gradients[k] = {by_axis(corner, 0) * height, by_axis(corner, 1) * height,
                      k < 3 ? -l[corner] : l[corner]};
  }
}

void set_pyramid(const Point& r, ShapeFunctions& n) {
  const auto& [x, y, z] = r;
  const double s = z < 1 ? 1 - z : std::numeric_limits<double>::quiet_NaN();
  const double a = x / s, b = y / s, q = a * y;
  const std::array values{s - x - y + q, x - q, q, y - q, z};
  const std::array<Point, 5> gradients{{{b - 1, a - 1, a * b - 1},
                                        {1 - b, -a, -a * b},
                                        {b, a, a * b},
                                        {-b, 1 - a, -a * b},
                                        {0, 0, 1}}};
  std::copy(values.begin(), values.end(), n.values.begin());
  std::copy(gradients.begin(), gradients.end(), n.gradients.begin());
}

void set_quadratic(const Point& r, ShapeFunctions& n) {
  const std::array<double, 4> l{1 - (r[0] + r[1] + r[2]), r[0], r[1], r[2]};
  for (std::size_t i = 0; i < 4; ++i) {
    n.values[i] = l[i] * (2 * l[i] - 1);
    for (std::size_t axis = 0; axis < 3; ++axis)
      n.gradients[i][axis] = by_axis(i, axis) * (4 * l[i] - 1);
  }
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [i, j] = tet_edges[e];
    n.values[4 + e] = 4 * l[i] * l[j];
    for (std::size_t axis = 0; axis < 3; ++axis)
      n.gradients[4 + e][axis] = 4 * (by_axis(i, axis) * l[j] + by_axis(j, axis) * l[i]);
  }
}

double largest(const Point& p) {
  return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
}

/// The derivatives of the point by r.
std::array<Point, 3> columns_of(const ShapeFunctions& n, std::span<const Point> x) {
  std::array<Point, 3> column{};
  for (std::size_t k = 0; k < x.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        column[i][axis] += n.gradients[k][i] * x[k][axis];
  return column;
}
double determinant(const std::array<Point, 3>& column) {
  return dot(column[0], cross(column[1], column[2]));
}

}  // namespace

ShapeFunctions shape_functions(std::size_t n_vertices, const Point& r) {
  ShapeFunctions n;
  if (n_vertices == 8 || n_vertices == 27) {
    set_hexahedron(n_vertices, r, n);
  } else {
    (n_vertices == 6 ? set_wedge : n_vertices == 5 ? set_pyramid : set_quadratic)(r, n);
  }
  return n;
}

Point reference_vertex(std::size_t n_vertices, std::size_t k) {
  Point r{};
  if (n_vertices == 8 || n_vertices == 27 || (n_vertices == 5 && k < 4)) {
    for (std::size_t axis = 0; axis < 3; ++axis) r[axis] = 0.5 * cube_vertices[k][axis];
  } else if (n_vertices == 5) {
    r[2] = 1;
  } else if (n_vertices == 6) {
    r = {k % 3 == 1 ? 1.0 : 0.0, k % 3 == 2 ? 1.0 : 0.0, k < 3 ? 0.0 : 1.0};
  } else if (k < 4) {
    if (k > 0) r[k - 1] = 1;
  } else {
    for (const std::size_t corner : tet_edges[k - 4])
      if (corner > 0) r[corner - 1] = 0.5;
  }
  return r;
}

double depth_in_element(std::size_t n_vertices, const Point& r) {
  const auto& [x, y, z] = r;
  if (n_vertices == 8 || n_vertices == 27) return std::min({x, y, z, 1 - x, 1 - y, 1 - z});
  if (n_vertices == 6) return std::min({x, y, 1 - (x + y), z, 1 - z});
  if (n_vertices == 10) return std::min({x, y, z, 1 - (x + y + z)});
  const double s = 1 - z;
  return s > 0 ? std::min({x / s, y / s, 1 - x / s, 1 - y / s, z}) : -1;
}

std::optional<Point> invert_element(const Point& p, std::span<const Point> vertices,
                                    const Point& start, double slack) {
  // Relative to the point, in the unit of the element: neither place nor scale costs a digit.
  std::array<Point, most_native_vertices> relative;
  const std::span<Point> x = std::span(relative).first(vertices.size());
  const std::size_t n = x.size();
  double size = 0;
  Point centre{};
  for (std::size_t k = 0; k < n; ++k) {
    x[k] = difference(vertices[k], p);
    size = std::max(size, largest(difference(vertices[k], vertices[0])));
    const Point r = reference_vertex(n, k);
    for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] += r[axis] / static_cast<double>(n);
  }
  if (!(size > 0)) return std::nullopt;
  for (Point& at : x)
    for (double& c : at) c /= size;
  const double orientation = determinant(columns_of(shape_functions(n, centre), x));
  Point r = start;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const ShapeFunctions shape = shape_functions(n, r);
    Point error{};
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) error[axis] += shape.values[k] * x[k][axis];
    const std::array<Point, 3> column = columns_of(shape, x);
    const double volume = determinant(column);
    if (!(volume * orientation > 0)) return std::nullopt;  // folds over
    const Point step{-dot(error, cross(column[1], column[2])) / volume,
                     -dot(column[0], cross(error, column[2])) / volume,
                     -dot(column[0], cross(column[1], error)) / volume};
    const double length = largest(step);
    if (!(length < 1e3)) return std::nullopt;
    const double damping = length > 0.5 ? 0.5 / length : 1;
    for (std::size_t axis = 0; axis < 3; ++axis) r[axis] += damping * step[axis];
    if (length < 1e-9 && largest(error) < 1e-12) {  // quadratic convergence: the step was the last
      if (!(depth_in_element(n, r) >= -slack)) return std::nullopt;
      return r;
    }
  }
  return std::nullopt;
}

}  // namespace tess::m2m
