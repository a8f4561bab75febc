#include "apps/overset/picture.hpp"

#include "apps/kit/output/canvas.hpp"

#include <algorithm>
#include <cmath>

namespace overset {
namespace {

using tess::m2m::Aabb;
using tess::m2m::Blanking;
using tess::m2m::Point;
using tess::m2m::Tet;
using tess::m2m::TetMesh;
using tess::m2m::VertexId;

constexpr double width = 800;

/// The plane across `depth` at `at`, what is to the right and up in it, and how the picture scales.
struct View {
  Aabb box{};
  std::size_t right = 0, up = 1, depth = 2;
  double at = 0;

  [[nodiscard]] double scale() const {
    return width / std::max(box.hi[right] - box.lo[right], box.hi[up] - box.lo[up]);
  }
  [[nodiscard]] double height() const { return (box.hi[up] - box.lo[up]) * scale(); }
};

/// Appends the polygon in which the plane meets a tetrahedron.
void append_cut(kit::Path& path, const TetMesh& mesh, const Tet& tet, const View& view) {
  const auto point = [&](VertexId v) { return mesh.points[static_cast<std::size_t>(v)]; };
  std::vector<VertexId> below, above;
  for (const VertexId v : tet) (point(v)[view.depth] < view.at ? below : above).push_back(v);
  if (below.empty() || above.empty()) return;
  std::vector<std::pair<VertexId, VertexId>> edges;
  for (const VertexId low : below)
    for (const VertexId high : above) edges.emplace_back(low, high);
  if (edges.size() == 4) std::swap(edges[2], edges[3]);  // around the quadrilateral
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Point p = point(edges[i].first), q = point(edges[i].second);
    const double t = (view.at - p[view.depth]) / (q[view.depth] - p[view.depth]);
    const auto along = [&](std::size_t k) {
      return (p[k] + t * (q[k] - p[k]) - view.box.lo[k]) * view.scale();
    };
    const kit::Point at{along(view.right), view.height() - along(view.up)};
    i == 0 ? path.move(at) : path.line(at);
  }
  path.close();
}

/// How a tetrahedron is drawn, by the worst of its corners.
enum class Look { field, fringe, orphan, hole };

Look look_of(const Tet& tet, const std::vector<std::int32_t>& iblank) {
  Look look = Look::field;
  for (const VertexId v : tet) {
    const std::int32_t mark = iblank[static_cast<std::size_t>(v)];
    look = std::max(look, mark == Blanking::hole     ? Look::hole
                          : mark == Blanking::orphan ? Look::orphan
                          : mark < 0                 ? Look::fringe
                                                     : Look::field);
  }
  return look;
}

}  // namespace

std::string picture(const Problem& problem, const Assembly& assembly, Moment moment) {
  View view;
  view.box = bounds(problem.meshes[0]);
  for (const TetMesh& mesh : problem.meshes)
    view.box = tess::collide::merged(view.box, bounds(mesh));
  Aabb middle = problem.walls[0].box();
  if (!problem.options.symmetry.empty()) {
    const Point& n = problem.options.symmetry[0].normal;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(n[k]) > std::abs(n[view.up])) view.up = k;
    view.right = view.up == 0 ? 1 : 0;
    view.depth = 3 - view.up - view.right;
    middle = bounds(problem.meshes[1]);  // without what closes the wall
  }
  // Not through a layer of vertices.
  view.at = middle.lo[view.depth] + 0.503 * (middle.hi[view.depth] - middle.lo[view.depth]);
  kit::Canvas canvas({.width = width, .height = view.height(), .margin = 10});
  constexpr std::array<const char*, 3> strokes{"#2c4a6e", "#b3541e", "#3f7d3a"};
  constexpr std::array<std::array<const char*, 3>, 3> fills{{{"none", "#b9d3ee", "#e00000"},
                                                             {"none", "#f6d5b8", "#e00000"},
                                                             {"none", "#cbe6c5", "#e00000"}}};
  for (std::size_t number = 0; number < problem.meshes.size(); ++number) {
    const std::size_t colour = number == 0 ? 0 : 1 + (number - 1) % 2;
    const TetMesh& mesh = problem.meshes[number];
    std::array<kit::Path, 3> paths;
    for (const Tet& tet : mesh.tets) {
      const Look look =
          moment == Moment::before ? Look::field : look_of(tet, assembly.meshes[number].iblank);
      if (look != Look::hole) append_cut(paths[static_cast<std::size_t>(look)], mesh, tet, view);
    }
    for (std::size_t look = 0; look < 3; ++look)
      canvas.path(
          paths[look],
          {.fill = fills[colour][look], .stroke = strokes[colour], .width = 0.6, .opacity = 0.8});
  }
  return canvas.svg();
}

}  // namespace overset
