#include "apps/overset/assembly.hpp"

#include "apps/kit/worst.hpp"
#include "apps/overset/body.hpp"
#include "apps/overset/grid.hpp"
#include "collide/read_surface.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <cmath>

namespace overset {
namespace {

using tess::m2m::Aabb;
using tess::m2m::TetMesh;
using tess::m2m::Wall;

Wall wall_from_file(const std::string& path, std::string& remarks) {
  const tess::dn::Surface surface = tess::dn::read_surface(path);
  remarks = remarks_text(surface);
  std::vector<Point> points;
  for (const auto& v : surface.vertices) points.push_back({v.x, v.y, v.z});
  std::vector<std::array<VertexId, 3>> triangles;
  for (const auto& [a, b, c] : surface.triangles)
    triangles.push_back(
        {static_cast<VertexId>(a), static_cast<VertexId>(b), static_cast<VertexId>(c)});
  return Wall(points, triangles);
}

/// Of the background and the overset mesh.
Aabb joint_box(const Problem& problem) {
  return tess::collide::merged(bounds(problem.meshes[0]), bounds(problem.meshes[1]));
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
    if (number == 0) {
      load.walls.push_back(problem.wall.seen_from(tess::collide::box_around(load.part.points)));
    } else {
      for (const auto id : load.part.point_ids)
        load.on_outer.push_back(problem.on_outer[static_cast<std::size_t>(id)]);
    }
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
  auto& [background, overset] = problem.meshes;
  background = tess::m2m::read_mesh(request.background);
  overset = names_body(request.overset) ? mesh_around(parse_body(request.overset))
                                        : tess::m2m::read_mesh(request.overset);
  overset.name = request.overset;
  const bool is_file = tess::dn::names_surface(request.wall);
  auto boundary = tess::m2m::overset_boundary(overset, is_file ? "" : request.wall);
  problem.on_outer = std::move(boundary.on_outer);
  if (!is_file && boundary.wall.empty())
    tess::fail(tess::ErrorCode::bad_mesh, request.overset,
               " has no cavity, so no wall is found; give --wall a side set or a surface file");
  problem.wall = is_file ? wall_from_file(request.wall, problem.wall_remarks)
                         : Wall(overset.points, boundary.wall);
  return problem;
}

tess::TaskOf<Assembly> assemble(const Problem& problem) {
  tess::ArrayProxy<Grid> background, overset;
  co_await tess::epoch([&] {
    background = place(problem, 0);
    overset = place(problem, 1);
  });
  tess::m2m::Coupling to_overset(background, overset), to_background(overset, background);

  const tess::Time start = tess::now();
  co_await tess::epoch([&] {
    background.broadcast<&Grid::cut>();
    overset.broadcast<&Grid::cut>();
  });
  const tess::Time have_holes = tess::now();
  auto one = to_overset.search(), other = to_background.search();
  co_await one;
  co_await other;
  co_await to_overset.apply<&Grid::flags, &Grid::offered>();
  co_await to_background.apply<&Grid::flags, &Grid::offered>();
  co_await tess::epoch([&] {
    overset.broadcast<&Grid::settle>(to_overset.id(), 1);
    background.broadcast<&Grid::settle>(to_background.id(), 2);
  });
  const tess::Time have_donors = tess::now();
  tess::Task down = to_overset.apply<&Grid::values, &Grid::taken>();
  tess::Task up = to_background.apply<&Grid::values, &Grid::taken>();
  co_await down;
  co_await up;
  co_await tess::epoch([&] {
    overset.broadcast<&Grid::use>(1);
    background.broadcast<&Grid::use>(2);
  });
  Assembly out;
  out.cut = tess::seconds(have_holes - start);
  out.search = tess::seconds(have_donors - have_holes);
  out.exchange = tess::seconds(tess::now() - have_donors);

  const std::array grids{background, overset};
  for (std::size_t number = 0; number < 2; ++number) {
    out.meshes[number].report = co_await grids[number].reduce<&Grid::report>();
    const Rows all = co_await grids[number].reduce<&Grid::gather>();
    keep(problem, number, all, out.meshes[number]);
  }
  out.hash = hash_of(out);
  co_await tess::epoch([&] {
    to_overset.destroy();
    to_background.destroy();
  });
  co_await tess::epoch([&] {
    background.destroy();
    overset.destroy();
  });
  co_return out;
}

}  // namespace overset
