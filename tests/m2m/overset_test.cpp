// Whole overset assemblies on the simulated machine, against answers by brute force.
#include "m2m/overset.hpp"

#include "apps/overset/assembly.hpp"
#include "apps/overset/body.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/rows/interpolate/orientation.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/overset/turned.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

using namespace tess;
using namespace tess::m2m;
using overset::Assembled, overset::Assembly, overset::Body, overset::Problem;

namespace {

using Triangles = std::vector<std::array<VertexId, 3>>;

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}
int up_to(std::mt19937& random, int least, int most) {
  return std::uniform_int_distribution<>(least, most)(random);
}

/// A whole body: the mesh around it has its points.
struct Solid {
  TetMesh mesh;
  Triangles surface;
};
struct Scene {
  Problem problem;
  std::vector<Solid> solids;  // per mesh around a body; moved as it is
};

/// Finds the walls of the meshes, in the planes of the problem.
Scene with_walls(Scene scene) {
  Problem& problem = scene.problem;
  for (TetMesh& mesh : problem.meshes) project(mesh.points, problem.options.symmetry);
  for (std::size_t number = 1; number < problem.meshes.size(); ++number) {
    const TetMesh& mesh = problem.meshes[number];
    OversetBoundary boundary = overset_boundary(mesh, {}, problem.options.symmetry);
    problem.walls.emplace_back(mesh.points, boundary.wall, problem.options.symmetry);
    problem.on_outer.push_back(std::move(boundary.on_outer));
  }
  return scene;
}

void add(Scene& scene, const Body& body) {
  Body whole = body;
  whole.half = {};
  scene.problem.meshes.push_back(mesh_around(body));
  scene.solids.push_back({mesh_around(whole), surface_of(whole)});
}

Scene random_scene(std::mt19937& random) {
  Body body;
  body.shape = static_cast<Body::Shape>(up_to(random, 0, 3));
  body.n = up_to(random, 3, 5);
  body.n_layers = up_to(random, 2, 4);
  body.radius = between(random, 0.15, 0.35);
  body.outer = between(random, 1.3, 2.2);
  for (std::size_t k = 0; k < 3; ++k) {
    body.centre[k] = between(random, 0.3, 0.7);
    body.turn[k] = between(random, 0, 6);
  }
  Scene scene;
  scene.problem.meshes = {kuhn_mesh({up_to(random, 5, 9), 0.15})};
  add(scene, body);
  scene.problem.options.fringe_layers = up_to(random, 1, 2);
  return with_walls(std::move(scene));
}

/// One or two bodies on one or two sides of the background, or near to them so that they reach
/// through; a third of the scenes is turned.
Scene random_symmetric_scene(std::mt19937& random) {
  Scene scene;
  auto& [meshes, walls, on_outer, remarks, field, options, n_parts] = scene.problem;
  meshes = {kuhn_mesh({up_to(random, 5, 8), 0.15})};
  options.fringe_layers = up_to(random, 1, 2);
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::shuffle(axes.begin(), axes.end(), random);
  const int n_planes = up_to(random, 1, 2), n_bodies = up_to(random, 1, 2);
  for (int k = 0; k < n_planes; ++k) {
    Point normal{};
    normal[axes[static_cast<std::size_t>(k)]] = 1;
    options.symmetry.push_back(symmetry_plane(normal, up_to(random, 0, 1), meshes[0].points));
  }
  for (int k = 0; k < n_bodies; ++k) {
    Body body;
    body.shape = static_cast<Body::Shape>(up_to(random, 0, 3));
    body.n = 4;
    body.n_layers = up_to(random, 2, 3);
    body.radius = between(random, 0.15, 0.35);
    body.outer = between(random, 1.3, 2.2);
    bool is_cut = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      body.centre[axis] = between(random, 0.3, 0.7);
      body.turn[axis] = between(random, 0, 6);
    }
    for (const SymmetryPlane& plane : options.symmetry)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (plane.normal[axis] == 0) continue;
        const bool stands = up_to(random, 0, 2) > 0;
        body.centre[axis] = plane.offset * plane.normal[axis];
        if (stands)
          body.half[axis] = plane.normal[axis] > 0 ? 1 : -1;
        else
          body.centre[axis] += body.radius * between(random, -0.8, 0.8);
        is_cut = is_cut || stands;
      }
    if (is_cut) body.turn = {};
    add(scene, body);
  }
  if (up_to(random, 0, 2) > 0) return with_walls(std::move(scene));
  const RigidMotion turn{.axis = {between(random, -1, 1), between(random, -1, 1), 1},
                         .angle = between(random, 0, 6),
                         .translation = {between(random, -9, 9), 3, 5}};
  for (TetMesh& mesh : meshes) move_points(mesh.points, turn);
  for (Solid& solid : scene.solids) move_points(solid.mesh.points, turn);
  for (SymmetryPlane& plane : options.symmetry) plane = test::turned(plane, turn);
  return with_walls(std::move(scene));
}

Assembly assembled(Problem problem, std::uint64_t seed) {
  problem.n_parts = 1 + static_cast<std::int32_t>(seed % 5);
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  Assembly out;
  machine.run([&]() -> Task { out = co_await overset::assemble(problem); }).require_success();
  return out;
}

/// Whether a segment to a point far away crosses an odd number of triangles, by exact signs. If it
/// meets an edge or a corner, another one is tried.
bool is_inside(const TetMesh& mesh, const Triangles& triangles, const Point& p,
               std::mt19937& random) {
  for (;;) {
    const Point q{between(random, 5, 9), between(random, -9, 9), between(random, -9, 9)};
    bool odd = false, again = false;
    for (const auto& t : triangles) {
      const auto at = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(t[i])]; };
      const Point a = at(0), b = at(1), c = at(2);
      const double from = orientation(p, a, b, c), to = orientation(q, a, b, c);
      const double u = orientation(p, q, a, b), v = orientation(p, q, b, c),
                   w = orientation(p, q, c, a);
      if (from == 0 || to == 0 || u == 0 || v == 0 || w == 0) again = true;
      if ((from > 0) != (to > 0) && (u > 0) == (v > 0) && (v > 0) == (w > 0)) odd = !odd;
    }
    if (!again) return odd;
  }
}

/// Per point: the number of edges to the nearest point of `from`, up to `most` + 1.
std::vector<int> edges_from(const TetMesh& mesh, std::vector<bool> from, int most) {
  std::vector<int> distance(mesh.n_points(), most + 1);
  for (int k = 0; k <= most; ++k) {
    std::vector<bool> next = from;
    for (std::size_t v = 0; v < from.size(); ++v)
      if (from[v]) distance[v] = std::min(distance[v], k);
    for (const Tet& tet : mesh.tets)
      for (const VertexId a : tet)
        for (const VertexId b : tet)
          if (from[static_cast<std::size_t>(a)]) next[static_cast<std::size_t>(b)] = true;
    from = next;
  }
  return distance;
}

/// What brute force says of a point: the tetrahedra that hold it, and of the last one the weights. A
/// donor is in a hole if corners there have more than the weight `ignored`.
struct Held {
  int n_tets = 0;
  bool any_hole = false, all_holes = true;
  double quality = 0;
};
Held held(const TetMesh& mesh, const std::vector<Role>& roles, const Point& p, double ignored) {
  Held out;
  for (const Tet& tet : mesh.tets) {
    std::array<Point, 4> c{};
    for (std::size_t i = 0; i < 4; ++i) c[i] = mesh.points[static_cast<std::size_t>(tet[i])];
    if (!overlap(collide::box_around(c), collide::box_of(p), collide::Touching::counts)) continue;
    const std::array<double, 4> volume{
        orientation(p, c[1], c[2], c[3]), -orientation(p, c[0], c[2], c[3]),
        orientation(p, c[0], c[1], c[3]), -orientation(p, c[0], c[1], c[2])};
    const auto [least, most] = std::minmax_element(volume.begin(), volume.end());
    if (*least < 0 && *most > 0) continue;
    ++out.n_tets;
    double hole = 0, field = 0, all = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Role role = roles[static_cast<std::size_t>(tet[i])];
      if (role == Role::hole) hole += volume[i];
      if (role == Role::field) field += volume[i];
      all += volume[i];
    }
    out.any_hole = out.any_hole || hole != 0;
    out.all_holes = out.all_holes && hole / all > ignored;
    out.quality = field / all;
  }
  return out;
}

struct Counts {
  int wrong_holes = 0, wrong_fringe = 0, blanked_donors = 0, wrong_orphans = 0, wrong_quality = 0;
  int holes = 0, fringe = 0, orphans = 0;
};

/// A point in planes of symmetry goes a little way into the domain: there rounding does not decide.
Point inwards(Point p, const std::vector<SymmetryPlane>& planes) {
  for (const SymmetryPlane& plane : planes)
    if (plane.holds(p))
      for (std::size_t k = 0; k < 3; ++k) p[k] += 1e-11 * plane.normal[k];
  return p;
}

void compare(const Scene& scene, const Assembly& assembly, std::mt19937& random, Counts& n) {
  const Problem& problem = scene.problem;
  std::vector<std::vector<Role>> roles(problem.meshes.size());
  const int layers = problem.options.fringe_layers;
  const auto& planes = problem.options.symmetry;
  for (std::size_t number = 0; number < roles.size(); ++number) {
    const TetMesh& mesh = problem.meshes[number];
    std::vector<bool> is_hole, is_outer;
    for (std::size_t v = 0; v < mesh.n_points(); ++v) {
      const Point& p = mesh.points[v];
      bool hole = std::any_of(planes.begin(), planes.end(),
                              [&](const SymmetryPlane& plane) { return plane.is_beyond(p); });
      for (std::size_t k = 0; k < scene.solids.size(); ++k)
        hole = hole || (k + 1 != number &&
                        is_inside(scene.solids[k].mesh, scene.solids[k].surface, p, random));
      is_hole.push_back(hole);
      is_outer.push_back(number > 0 && problem.on_outer[number - 1][v] != 0);
    }
    const std::vector<int> from_hole = edges_from(mesh, is_hole, layers),
                           from_outer = edges_from(mesh, is_outer, layers - 1);
    for (std::size_t v = 0; v < mesh.n_points(); ++v) {
      const Role role = is_hole[v]                                              ? Role::hole
                        : from_hole[v] <= layers || from_outer[v] <= layers - 1 ? Role::fringe
                                                                                : Role::field;
      roles[number].push_back(role);
      const std::int32_t iblank = assembly.meshes[number].iblank[v];
      n.wrong_holes += (iblank == Blanking::hole) != (role == Role::hole) ? 1 : 0;
      n.wrong_fringe +=
          (iblank < 0 || iblank == Blanking::orphan) != (role == Role::fringe) ? 1 : 0;
      n.holes += role == Role::hole ? 1 : 0;
      n.fringe += role == Role::fringe ? 1 : 0;
    }
  }
  for (std::size_t number = 0; number < roles.size(); ++number) {
    const TetMesh& mesh = problem.meshes[number];
    for (std::size_t v = 0; v < mesh.n_points(); ++v) {
      if (roles[number][v] != Role::fringe) continue;
      const std::int32_t iblank = assembly.meshes[number].iblank[v];
      n.orphans += iblank == Blanking::orphan ? 1 : 0;
      for (std::size_t other = 0; other < roles.size(); ++other) {
        if (other == number || (iblank < 0 && iblank != -static_cast<int>(other) - 1)) continue;
        const Point p = inwards(mesh.points[v], planes);
        const Held donor =
            held(problem.meshes[other], roles[other], p, p == mesh.points[v] ? 0 : 1e-9);
        if (iblank == Blanking::orphan) {
          n.wrong_orphans += donor.n_tets > 0 && !donor.any_hole ? 1 : 0;
        } else {
          n.blanked_donors += donor.n_tets == 0 || donor.all_holes ? 1 : 0;
          if (donor.n_tets == 1)
            n.wrong_quality +=
                std::abs(assembly.meshes[number].quality[v] - donor.quality) > 1e-9 ? 1 : 0;
        }
      }
    }
  }
}

void check_none_wrong(const Counts& n) {
  CHECK(n.wrong_holes == 0);
  CHECK(n.wrong_fringe == 0);
  CHECK(n.blanked_donors == 0);
  CHECK(n.wrong_orphans == 0);
  CHECK(n.wrong_quality == 0);
}

}  // namespace

TEST_CASE("200 random overset assemblies: holes, fringes, donors and orphans as by brute force",
          "[m2m][overset]") {
  std::mt19937 random(17);
  Counts n;
#ifdef TESS_CHECKS_ALL
  constexpr int n_assemblies = 50;
#else
  constexpr int n_assemblies = 200;
#endif
  for (std::uint64_t k = 0; k < n_assemblies; ++k) {
    INFO("assembly " << k);
    const Scene scene = random_scene(random);
    const Assembly assembly = assembled(scene.problem, k);
    CHECK(assembled(scene.problem, 3 * k + 7).hash == assembly.hash);
    compare(scene, assembly, random, n);
    // A linear field is exact where donors have computed values.
    if (k % 10 == 0) {
      Problem linear = scene.problem;
      linear.field = "linear";
      const Assembly exact = assembled(linear, k);
      CHECK(exact.meshes[0].linf < 1e-12);
      CHECK(exact.meshes[1].linf < 1e-12);
    }
  }
  check_none_wrong(n);
  CHECK(n.holes > 10 * n_assemblies);
  CHECK(n.fringe > 100 * n_assemblies);
  CHECK(n.orphans > n_assemblies);
}

// TESS_OVERSET_CASES=200 runs as many of them.
TEST_CASE("random bodies on one and two planes of symmetry: as whole bodies in the domain",
          "[m2m][overset]") {
  std::mt19937 random(23);
  Counts n;
  const char* const given = std::getenv("TESS_OVERSET_CASES");
  const std::uint64_t n_scenes = given != nullptr ? std::strtoull(given, nullptr, 10) : 8;
  for (std::uint64_t k = 0; k < n_scenes; ++k) {
    INFO("scene " << k);
    const Scene scene = random_symmetric_scene(random);
    const Assembly assembly = assembled(scene.problem, k);
    CHECK(assembled(scene.problem, 3 * k + 7).hash == assembly.hash);
    Counts of_scene;
    compare(scene, assembly, random, of_scene);
    check_none_wrong(of_scene);
    n.holes += of_scene.holes, n.fringe += of_scene.fringe, n.orphans += of_scene.orphans;
  }
  if (given != nullptr)
    WARN(n_scenes << " scenes: " << n.holes << " holes, " << n.fringe << " fringe points, "
                  << n.orphans << " of them orphans; none is wrong");
  CHECK(n.holes > 10 * static_cast<int>(n_scenes));
  CHECK(n.fringe > 50 * static_cast<int>(n_scenes));
}

TEST_CASE("a body moves through a plane of symmetry: its part in the domain cuts the hole",
          "[m2m][overset]") {
  std::mt19937 random(29);
  Scene start;
  start.problem.meshes = {kuhn_mesh({10, 0.1})};
  start.problem.options.symmetry = {symmetry_plane({0, 0, 1}, 0, start.problem.meshes[0].points)};
  Body ball{.n = 4, .n_layers = 4, .centre = {0.5, 0.5, 0.48}, .radius = 0.15, .outer = 3};
  add(start, ball);
  std::vector<std::uint64_t> n_holes;
  for (int step = 0; step <= 5; ++step) {
    INFO("step " << step);
    Scene scene = start;
    const RigidMotion motion{.axis = {1, 1, 0},
                             .angle = 0.3 * step,
                             .centre = ball.centre,
                             .translation = {0, 0, -0.14 * step}};
    move_points(scene.problem.meshes[1].points, motion);
    move_points(scene.solids[0].mesh.points, motion);
    scene = with_walls(std::move(scene));
    const Assembly assembly = assembled(scene.problem, static_cast<std::uint64_t>(step));
    Counts n;
    compare(scene, assembly, random, n);
    check_none_wrong(n);
    n_holes.push_back(assembly.meshes[0].report.n_hole);
    for (const Orphan& orphan : assembly.meshes[0].report.orphans) {
      CHECK(orphan.reason == Orphan::Reason::hole);  // beside the plane, where the body leaves it
      CHECK(orphan.at[2] < 0.2);
    }
    if (step == 0) CHECK(n.orphans == 0);
  }
  CHECK(n_holes[0] > 5);
  CHECK(n_holes[2] > n_holes[4]);
  CHECK(n_holes[5] == 0);  // the body has left the domain; so has nearly all of its mesh
}

TEST_CASE("a gap of one cell between two bodies, and between a body and a plane",
          "[m2m][overset]") {
  std::mt19937 random(31);
  const double cell = 0.1;
  Scene scene;
  scene.problem.meshes = {kuhn_mesh({10})};
  scene.problem.options.symmetry = {symmetry_plane({0, 0, 1}, 0, scene.problem.meshes[0].points)};
  Body body{.shape = Body::Shape::ball, .n = 4, .n_layers = 3, .radius = 0.15, .turn = {}};
  const double apart = 2 * 0.15 + cell, above = 0.15 + cell;
  for (const double x : {0.299, 0.299 + std::sqrt(apart * apart - above * above)}) {
    body.centre = {x, 0.497, x < 0.5 ? above : 0};
    body.half = {0, 0, x < 0.5 ? 0 : 1};
    add(scene, body);
  }
  scene = with_walls(std::move(scene));
  const Assembly assembly = assembled(scene.problem, 3);
  Counts n;
  compare(scene, assembly, random, n);
  check_none_wrong(n);
  std::uint64_t n_orphans = 0;
  for (const auto& mesh : assembly.meshes) {
    n_orphans += mesh.report.n_orphans;
    CHECK(mesh.report.orphans.size() == mesh.report.n_orphans);
  }
  CHECK(n_orphans == static_cast<std::uint64_t>(n.orphans));
  CHECK(assembly.meshes[1].report.n_hole > 0);
}

TEST_CASE("half a ball of gmsh on a plane of symmetry: the hole is that of the ball",
          "[.][meshes]") {
  const overset::Request request{.background = test::made_mesh("half_sphere_1"),
                                 .overset = {test::made_mesh("half_sphere_2")},
                                 .wall = "",
                                 .symmetry = {"z=0"}};
  const Problem problem = overset::read_problem(request);
  const Assembly assembly = assembled(problem, 3);
  CHECK(problem.walls[0].rim().n_on_symmetry == 1);
  const Assembled &background = assembly.meshes[0], &around = assembly.meshes[1];
  int n_in_plane = 0, n_wrong = 0;
  for (std::size_t v = 0; v < problem.meshes[0].n_points(); ++v) {
    const Point& p = problem.meshes[0].points[v];
    const bool is_hole = background.iblank[v] == Blanking::hole;
    const double r = collide::length(p);
    n_wrong += (r > 0.4 && is_hole) || (r < 0.37 && !is_hole) ? 1 : 0;
    n_in_plane += is_hole && p[2] == 0 ? 1 : 0;
  }
  CHECK(n_wrong == 0);
  CHECK(n_in_plane > 5);
  CHECK(background.report.n_orphans + around.report.n_orphans == 0);
}
