#include "apps/kit/output/canvas.hpp"
#include "apps/m2m_transfer/output/transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace m2m_transfer {
namespace {

/// A plane perpendicular to the axis `across`. The axes `right` and `up` span the picture.
struct Plane {
  std::size_t across = 2, right = 0, up = 1;
  double at = 0;
};

/// At three tenths of the box. (In the middle a sine is zero, and many meshes have a symmetry
/// plane.)
Plane plane_through(const Aabb& box) {
  const auto side = [&](std::size_t axis) { return box.hi[axis] - box.lo[axis]; };
  Plane plane;
  for (const std::size_t axis : {1U, 0U})
    if (side(axis) < side(plane.across)) plane.across = axis;
  plane.right = plane.across == 0 ? 1 : 0;
  plane.up = plane.across == 2 ? 1 : 2;
  plane.at = box.lo[plane.across] + 0.3 * side(plane.across);
  return plane;
}

/// The intersection of the plane with an edge of a tetrahedron.
struct Corner {
  double x = 0, y = 0, value = 0;
};
/// The intersection of the plane with a tetrahedron: zero, three or four corners in order.
struct Polygon {
  std::array<Corner, 4> corners{};
  std::size_t n = 0;

  [[nodiscard]] double value() const {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += corners[i].value;
    return sum / static_cast<double>(n);
  }
};

Polygon cut(const TetMesh& mesh, const Tet& tet, std::span<const double> values,
            const Plane& plane) {
  std::array<VertexId, 4> below{}, above{};
  std::size_t n_below = 0, n_above = 0;
  for (const VertexId v : tet) {
    if (mesh.points[static_cast<std::size_t>(v)][plane.across] < plane.at)
      below[n_below++] = v;
    else
      above[n_above++] = v;
  }
  Polygon polygon;
  const auto meet = [&](VertexId low, VertexId high) {
    const Point& p = mesh.points[static_cast<std::size_t>(low)];
    const Point& q = mesh.points[static_cast<std::size_t>(high)];
    const double t = (plane.at - p[plane.across]) / (q[plane.across] - p[plane.across]);
    const auto mix = [t](double a, double b) { return a + t * (b - a); };
    polygon.corners[polygon.n++] = {
        mix(p[plane.right], q[plane.right]), mix(p[plane.up], q[plane.up]),
        mix(values[static_cast<std::size_t>(low)], values[static_cast<std::size_t>(high)])};
  };
  if (n_below == 2) {  // around the quadrilateral
    meet(below[0], above[0]);
    meet(below[0], above[1]);
    meet(below[1], above[1]);
    meet(below[1], above[0]);
  } else {
    for (std::size_t i = 0; i < n_below; ++i)
      for (std::size_t k = 0; k < n_above; ++k) meet(below[i], above[k]);
  }
  return polygon;
}

constexpr std::size_t n_colours = 64;
/// From dark blue over green to yellow, perceptually uniform (five points of matplotlib's viridis).
constexpr std::array<kit::Rgb, 5> colours{
    {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};

constexpr double panel = 480, margin = 30;

/// Draws one panel of the picture, with the colour scale below it.
void draw(kit::Canvas& canvas, const TetMesh& mesh, std::span<const double> values,
          const std::string& title, double left) {
  const Aabb box = bounds(mesh);
  const Plane plane = plane_through(box);
  const double scale = panel / std::max(box.hi[plane.right] - box.lo[plane.right],
                                        box.hi[plane.up] - box.lo[plane.up]);
  std::vector<Polygon> polygons;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (const Tet& tet : mesh.tets) {
    const Polygon polygon = cut(mesh, tet, values, plane);
    if (polygon.n == 0 || !std::isfinite(polygon.value())) continue;
    least = std::min(least, polygon.value());
    greatest = std::max(greatest, polygon.value());
    polygons.push_back(polygon);
  }
  std::array<kit::Path, n_colours> paths;
  for (const Polygon& polygon : polygons) {
    const double at = greatest > least ? (polygon.value() - least) / (greatest - least) : 0;
    kit::Path& path = paths[static_cast<std::size_t>(at * (n_colours - 1) + 0.5)];
    for (std::size_t i = 0; i < polygon.n; ++i) {
      const kit::Point corner{left + (polygon.corners[i].x - box.lo[plane.right]) * scale,
                              margin + panel - (polygon.corners[i].y - box.lo[plane.up]) * scale};
      i == 0 ? path.move(corner) : path.line(corner);
    }
    path.close();
  }
  for (std::size_t level = 0; level < n_colours; ++level) {
    const double at = static_cast<double>(level) / (n_colours - 1);
    const std::string colour = kit::hex_colour(kit::colour_between(colours, at));
    canvas.path(paths[level], {.fill = colour, .stroke = colour, .width = 0.5});
  }
  canvas.ramp({left, margin + panel + 10}, panel, 10, n_colours, colours);
  canvas.text({left, margin - 10},
              fmt::format("{}, {} = {:.4g}", title, "xyz"[plane.across], plane.at));
  canvas.text({left, margin + panel + 36}, fmt::format("{:.4g}", least));
  canvas.text({left + panel, margin + panel + 36}, fmt::format("{:.4g}", greatest),
              kit::Anchor::end);
}

}  // namespace

std::string picture(const Problem& problem) {
  const RunMesh& target = problem.target_of(problem.pairs.back());
  const Field& field = target.fields.front();
  TetMesh there = *target.mesh;
  for (const RigidMotion& motion : target.back) move_points(there.points, motion);
  const Field truth = sample(there, field.name, problem.formulas.front());
  std::vector<double> error(field.values.size());
  for (std::size_t v = 0; v < error.size(); ++v)
    error[v] = std::abs(field.values[v] - truth.values[v]);
  kit::Canvas canvas(
      {.width = 2 * panel + 3 * margin, .height = panel + 2 * margin + 20, .font = 14});
  draw(canvas, *target.mesh, field.values, field.name, margin);
  draw(canvas, *target.mesh, error, "|error| of " + field.name, 2 * margin + panel);
  return canvas.svg();
}

}  // namespace m2m_transfer
