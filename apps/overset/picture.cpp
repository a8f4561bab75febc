#include "apps/overset/picture.hpp"

#include "apps/kit/output/canvas.hpp"

#include <algorithm>

namespace overset {
namespace {

using tess::m2m::Aabb;
using tess::m2m::Blanking;
using tess::m2m::Point;
using tess::m2m::Tet;
using tess::m2m::TetMesh;
using tess::m2m::VertexId;

constexpr double width = 800;

/// The plane z = at, and how the picture scales.
struct View {
  Aabb box{};
  double at = 0;

  [[nodiscard]] double scale() const {
    return width / std::max(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1]);
  }
  [[nodiscard]] double height() const { return (box.hi[1] - box.lo[1]) * scale(); }
};

/// Appends the polygon in which the plane meets a tetrahedron.
void append_cut(kit::Path& path, const TetMesh& mesh, const Tet& tet, const View& view) {
  const auto point = [&](VertexId v) { return mesh.points[static_cast<std::size_t>(v)]; };
  std::vector<VertexId> below, above;
  for (const VertexId v : tet) (point(v)[2] < view.at ? below : above).push_back(v);
  if (below.empty() || above.empty()) return;
  std::vector<std::pair<VertexId, VertexId>> edges;
  for (const VertexId low : below)
    for (const VertexId high : above) edges.emplace_back(low, high);
  if (edges.size() == 4) std::swap(edges[2], edges[3]);  // around the quadrilateral
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Point p = point(edges[i].first), q = point(edges[i].second);
    const double t = (view.at - p[2]) / (q[2] - p[2]);
    const kit::Point at{(p[0] + t * (q[0] - p[0]) - view.box.lo[0]) * view.scale(),
                        view.height() - (p[1] + t * (q[1] - p[1]) - view.box.lo[1]) * view.scale()};
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
  view.box = tess::collide::merged(bounds(problem.meshes[0]), bounds(problem.meshes[1]));
  const Aabb wall = problem.wall.box();
  view.at = wall.lo[2] + 0.503 * (wall.hi[2] - wall.lo[2]);  // not through a layer of vertices
  kit::Canvas canvas({.width = width, .height = view.height(), .margin = 10});
  constexpr std::array<const char*, 2> strokes{"#2c4a6e", "#b3541e"};
  constexpr std::array<std::array<const char*, 3>, 2> fills{
      {{"none", "#b9d3ee", "#e00000"}, {"none", "#f6d5b8", "#e00000"}}};
  for (std::size_t number = 0; number < 2; ++number) {
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
          {.fill = fills[number][look], .stroke = strokes[number], .width = 0.6, .opacity = 0.8});
  }
  return canvas.svg();
}

}  // namespace overset
