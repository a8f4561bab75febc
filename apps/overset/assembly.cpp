#include "apps/overset/assembly.hpp"

#include "apps/kit/worst.hpp"
#include "apps/overset/body.hpp"
#include "apps/overset/grid.hpp"
#include "collide/read_surface.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <cmath>

namespace overset {
namespace {

using tess::collide::length;
using tess::m2m::Aabb;
using tess::m2m::SymmetryPlane;
using tess::m2m::TetMesh;
using tess::m2m::Wall;

struct Surface {
  std::vector<Point> points;
  std::vector<std::array<VertexId, 3>> triangles;
};
Surface surface_from_file(const std::string& path, std::string& remarks) {
  const tess::dn::Surface surface = tess::dn::read_surface(path);
  remarks = remarks_text(surface);
  Surface out;
  for (const auto& v : surface.vertices) out.points.push_back({v.x, v.y, v.z});
  for (const auto& [a, b, c] : surface.triangles)
    out.triangles.push_back(
        {static_cast<VertexId>(a), static_cast<VertexId>(b), static_cast<VertexId>(c)});
  return out;
}

/// Holds all meshes.
Aabb joint_box(const Problem& problem) {
  Aabb box = bounds(problem.meshes[0]);
  for (const TetMesh& mesh : problem.meshes) box = tess::collide::merged(box, bounds(mesh));
  return box;
}

SymmetryPlane plane_named(std::string_view name, const TetMesh& background) {
  Point normal{};
  std::string_view text = name;
  if (const std::size_t axis = std::string_view("xyz").find(name.substr(0, 1)); axis < 3) {
    normal[axis] = 1;
    text.remove_prefix(1);
  } else {
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0 && text.starts_with(':')) text.remove_prefix(1);
      normal[k] = tess::take_number<double>(text).value_or(NAN);
    }
  }
  const bool has_offset = text.starts_with('=');
  const auto offset = tess::parse_number<double>(text.substr(has_offset ? 1 : 0));
  if (!has_offset || !offset || std::isnan(length(normal)))
    tess::fail(tess::ErrorCode::bad_argument, "--symmetry ", name,
               " is no plane; give one as z=0, or as 0.6:0.8:0=2 for 0.6 x + 0.8 y = 2");
  return tess::m2m::symmetry_plane(normal, *offset, background.points);
}

/// The sides of the background's box that are not given and hold a point of the mesh.
std::vector<SymmetryPlane> other_sides(const TetMesh& background,
                                       const std::vector<SymmetryPlane>& given,
                                       const std::vector<Point>& points) {
  const Aabb box = bounds(background);
  std::vector<SymmetryPlane> sides;
  for (std::size_t k = 0; k < 3; ++k)
    for (const double at : {box.lo[k], box.hi[k]}) {
      Point normal{};
      normal[k] = 1;
      const SymmetryPlane side = tess::m2m::symmetry_plane(normal, at, background.points);
      const auto holds = [&](const Point& p) { return side.holds(p); };
      if (std::find(given.begin(), given.end(), side) == given.end() &&
          std::any_of(points.begin(), points.end(), holds))
        sides.push_back(side);
    }
  return sides;
}

/// Reads the mesh around a body, and finds its wall. `is_met`: per plane of symmetry.
void add_body(const Request& request, const std::string& name, Problem& problem,
              std::vector<bool>& is_met) {
  const std::vector<SymmetryPlane>& given = problem.options.symmetry;
  TetMesh mesh =
      names_body(name) ? mesh_around(parse_body(name, given)) : tess::m2m::read_mesh(name);
  mesh.name = name;
  tess::m2m::project(mesh.points, given);
  const bool is_file = tess::dn::names_surface(request.wall);
  Surface surface =
      is_file ? surface_from_file(request.wall, problem.wall_remarks) : Surface{mesh.points, {}};
  std::vector<SymmetryPlane> planes = given;
  for (const SymmetryPlane& side : other_sides(problem.meshes[0], given, surface.points))
    planes.push_back(side);
  const std::string side_set = is_file ? "" : request.wall;
  auto boundary = tess::m2m::overset_boundary(mesh, side_set, planes);
  if (!is_file) surface.triangles = boundary.wall;
  const auto n_edges = tess::m2m::rim_edges_in(surface.points, surface.triangles, planes);
  std::vector<SymmetryPlane> missing;
  for (std::size_t k = given.size(); k < planes.size(); ++k)
    if (n_edges[k] > 0) missing.push_back(planes[k]);
  if (!missing.empty() && !tess::m2m::same_direction(surface.triangles))
    tess::fail(tess::ErrorCode::bad_mesh, "the wall's rim lies in ", text_of(missing),
               ", which is a boundary of the background: give --symmetry ", text_of(missing));
  if (planes.size() > given.size()) boundary = tess::m2m::overset_boundary(mesh, side_set, given);
  if (!is_file && boundary.wall.empty())
    tess::fail(tess::ErrorCode::bad_mesh, name,
               " has no cavity, so no wall is found; give --wall a side set or a surface file");
  problem.walls.emplace_back(surface.points, is_file ? surface.triangles : boundary.wall, given);
  problem.on_outer.push_back(std::move(boundary.on_outer));
  for (std::size_t k = 0; k < given.size(); ++k)
    is_met[k] = is_met[k] || n_edges[k] > 0 ||
                std::any_of(mesh.points.begin(), mesh.points.end(),
                            [&](const Point& p) { return given[k].is_beyond(p); });
  problem.meshes.push_back(std::move(mesh));
}

tess::ArrayProxy<Grid> place(const Problem& problem, std::size_t number) {
  const TetMesh& mesh = problem.meshes[number];
  const auto field = tess::m2m::make_formula(problem.field, joint_box(problem));
  (void)tess::m2m::sample(mesh, problem.field, field);  // refuses values that are not finite
  const auto grids = tess::create<Grid>(tess::range(problem.n_parts));
  auto parts = tess::m2m::mesh_parts(mesh, problem.n_parts, tess::m2m::PartitionMethod::rcb,
                                     problem.options.fringe_layers);
  for (std::int32_t k = 0; k < problem.n_parts; ++k) {
    GridLoad load{.part = std::move(parts[static_cast<std::size_t>(k)]),
                  .options = problem.options};
    for (const Point& p : load.part.points) load.values.push_back(field(p));
    const Aabb box = tess::collide::box_around(load.part.points);
    for (std::size_t body = 0; body < problem.walls.size(); ++body)
      if (body + 1 != number) load.walls.push_back(problem.walls[body].seen_from(box));
    if (number > 0)
      for (const auto id : load.part.point_ids)
        load.on_outer.push_back(problem.on_outer[number - 1][static_cast<std::size_t>(id)]);
    grids[{k}].send<&Grid::load>(std::move(load));
  }
  return grids;
}

/// The rows in the order of the mesh, and the error of the fringe.
void keep(const Problem& problem, std::size_t number, const Rows& rows, Assembled& out) {
  const TetMesh& mesh = problem.meshes[number];
  const auto field = tess::m2m::make_formula(problem.field, joint_box(problem));
  out.iblank.resize(mesh.n_points());
  out.quality.resize(mesh.n_points());
  out.values.resize(mesh.n_points());
  for (std::size_t i = 0; i < rows.points.size(); ++i) {
    const auto v = static_cast<std::size_t>(rows.points[i]);
    out.iblank[v] = rows.iblank[i];
    out.quality[v] = rows.quality[i];
    out.values[v] = rows.values[i];
  }
  double squares = 0;
  for (std::size_t v = 0; v < mesh.n_points(); ++v) {
    if (out.iblank[v] >= 0) continue;
    const double error = std::abs(out.values[v] - field(mesh.points[v]));
    kit::worsen(out.linf, error);
    squares += error * error;
  }
  if (out.report.n_fringe > 0)
    out.rms = std::sqrt(squares / static_cast<double>(out.report.n_fringe));
}

std::uint64_t hash_of(const Assembly& assembly) {
  std::uint64_t hash = 0;
  for (const Assembled& mesh : assembly.meshes) {
    hash = tess::m2m::result_hash(mesh.quality, hash);
    hash = tess::m2m::result_hash(mesh.values, hash);
    hash += tess::hash_bytes(mesh.iblank.data(), mesh.iblank.size() * sizeof mesh.iblank[0]);
  }
  return hash;
}

}  // namespace

Problem read_problem(const Request& request) {
  Problem problem;
  TetMesh& background = problem.meshes.emplace_back(tess::m2m::read_mesh(request.background));
  std::vector<SymmetryPlane>& planes = problem.options.symmetry;
  for (const std::string& name : request.symmetry) {
    const SymmetryPlane plane = plane_named(name, background);
    if (std::find(planes.begin(), planes.end(), plane) != planes.end())
      tess::fail(tess::ErrorCode::bad_argument, "--symmetry ", name, " is given twice");
    planes.push_back(plane);
  }
  tess::m2m::project(background.points, planes);
  if (request.overset.size() > 1 && !request.wall.empty())
    tess::fail(tess::ErrorCode::bad_argument, "--wall ", request.wall, " with ",
               request.overset.size(), " meshes around bodies: give one mesh, or leave --wall out");
  std::vector<bool> is_met(planes.size());
  for (const std::string& name : request.overset) add_body(request, name, problem, is_met);
  for (std::size_t k = 0; k < planes.size(); ++k)
    if (!is_met[k])
      tess::fail(tess::ErrorCode::bad_argument, "--symmetry ", text_of(planes[k]),
                 ": no wall has a rim in it, and no mesh reaches beyond it; leave it out");
  return problem;
}

tess::TaskOf<Assembly> assemble(const Problem& problem) {
  const std::size_t n_meshes = problem.meshes.size();
  std::vector<tess::ArrayProxy<Grid>> grids;
  co_await tess::epoch([&] {
    for (std::size_t number = 0; number < n_meshes; ++number)
      grids.push_back(place(problem, number));
  });
  struct Way {
    std::size_t from, to;
    tess::m2m::Coupling<Grid, Grid> coupling;
  };
  std::vector<Way> ways;
  for (std::size_t from = 0; from < n_meshes; ++from)
    for (std::size_t to = 0; to < n_meshes; ++to)
      if (from != to) ways.push_back({from, to, {grids[from], grids[to]}});

  const tess::Time start = tess::now();
  co_await tess::epoch([&] {
    for (const auto& grid : grids) grid.broadcast<&Grid::cut>();
  });
  const tess::Time have_holes = tess::now();
  std::vector<tess::TaskOf<tess::m2m::SearchSummary>> searches;
  for (Way& way : ways) searches.push_back(way.coupling.search());
  for (auto& search : searches) co_await search;
  for (Way& way : ways) co_await way.coupling.apply<&Grid::flags, &Grid::offered>();
  co_await tess::epoch([&] {
    for (const Way& way : ways)
      grids[way.to].broadcast<&Grid::settle>(way.coupling.id(),
                                             static_cast<std::int32_t>(way.from + 1));
  });
  const tess::Time have_donors = tess::now();
  std::vector<tess::Task> applications;
  for (Way& way : ways) applications.push_back(way.coupling.apply<&Grid::values, &Grid::taken>());
  for (tess::Task& application : applications) co_await application;
  co_await tess::epoch([&] {
    for (const Way& way : ways)
      grids[way.to].broadcast<&Grid::use>(way.coupling.id(),
                                          static_cast<std::int32_t>(way.from + 1));
  });
  Assembly out;
  out.cut = tess::seconds(have_holes - start);
  out.search = tess::seconds(have_donors - have_holes);
  out.exchange = tess::seconds(tess::now() - have_donors);

  out.meshes.resize(n_meshes);
  for (std::size_t number = 0; number < n_meshes; ++number) {
    out.meshes[number].report = co_await grids[number].reduce<&Grid::report>();
    const Rows all = co_await grids[number].reduce<&Grid::gather>();
    keep(problem, number, all, out.meshes[number]);
  }
  out.hash = hash_of(out);
  co_await tess::epoch([&] {
    for (Way& way : ways) way.coupling.destroy();
  });
  co_await tess::epoch([&] {
    for (const auto& grid : grids) grid.destroy();
  });
  co_return out;
}

}  // namespace overset
