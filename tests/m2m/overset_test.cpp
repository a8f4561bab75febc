// Whole overset assemblies on the simulated machine, against answers by brute force.
#include "m2m/overset.hpp"

#include "apps/overset/assembly.hpp"
#include "apps/overset/body.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/rows/interpolate/orientation.hpp"
#include "runtime/more/testing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>

using namespace tess;
using namespace tess::m2m;
using overset::Assembly, overset::Body, overset::Problem;

namespace {

using Triangles = std::vector<std::array<VertexId, 3>>;

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}
int up_to(std::mt19937& random, int least, int most) {
  return std::uniform_int_distribution<>(least, most)(random);
}

/// With the surface of its body.
std::pair<Problem, Triangles> random_problem(std::mt19937& random) {
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
  Problem problem;
  problem.meshes = {kuhn_mesh({up_to(random, 5, 9), 0.15}), mesh_around(body)};
  const OversetBoundary boundary = overset_boundary(problem.meshes[1]);
  problem.wall = Wall(problem.meshes[1].points, boundary.wall);
  problem.on_outer = boundary.on_outer;
  problem.options.fringe_layers = up_to(random, 1, 2);
  return {std::move(problem), surface_of(body)};
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

/// What brute force says of a point: the tetrahedra that hold it, and of the last one the weights.
struct Held {
  int n_tets = 0;
  bool any_hole = false, all_holes = true;
  double quality = 0;
};
Held held(const TetMesh& mesh, const std::vector<Role>& roles, const Point& p) {
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
    bool has_hole = false;
    double field = 0, all = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Role role = roles[static_cast<std::size_t>(tet[i])];
      if (role == Role::hole && volume[i] != 0) has_hole = true;
      if (role == Role::field) field += volume[i];
      all += volume[i];
    }
    out.any_hole = out.any_hole || has_hole;
    out.all_holes = out.all_holes && has_hole;
    out.quality = field / all;
  }
  return out;
}

struct Counts {
  int wrong_holes = 0, wrong_fringe = 0, blanked_donors = 0, wrong_orphans = 0, wrong_quality = 0;
  int holes = 0, fringe = 0, orphans = 0;
};

void compare(const Problem& problem, const Triangles& surface, const Assembly& assembly,
             std::mt19937& random, Counts& n) {
  std::array<std::vector<Role>, 2> roles;
  const int layers = problem.options.fringe_layers;
  for (std::size_t number = 0; number < 2; ++number) {
    const TetMesh& mesh = problem.meshes[number];
    std::vector<bool> is_seed;  // holes, or the outer boundary
    for (std::size_t v = 0; v < mesh.n_points(); ++v)
      is_seed.push_back(number == 0 ? is_inside(problem.meshes[1], surface, mesh.points[v], random)
                                    : problem.on_outer[v] != 0);
    const int most = number == 0 ? layers : layers - 1;
    const std::vector<int> distance = edges_from(mesh, is_seed, most);
    for (std::size_t v = 0; v < mesh.n_points(); ++v) {
      const Role role = number == 0 && is_seed[v] ? Role::hole
                        : distance[v] <= most     ? Role::fringe
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
  for (std::size_t number = 0; number < 2; ++number) {
    const TetMesh& mesh = problem.meshes[number];
    for (std::size_t v = 0; v < mesh.n_points(); ++v) {
      if (roles[number][v] != Role::fringe) continue;
      const Held donor = held(problem.meshes[1 - number], roles[1 - number], mesh.points[v]);
      const bool is_orphan = assembly.meshes[number].iblank[v] == Blanking::orphan;
      n.orphans += is_orphan ? 1 : 0;
      if (is_orphan) {
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
    const auto [problem, surface] = random_problem(random);
    const Assembly assembly = assembled(problem, k);
    CHECK(assembled(problem, 3 * k + 7).hash == assembly.hash);
    compare(problem, surface, assembly, random, n);
    // A linear field is exact where donors have computed values.
    if (k % 10 == 0) {
      Problem linear = problem;
      linear.field = "linear";
      const Assembly exact = assembled(linear, k);
      CHECK(exact.meshes[0].linf < 1e-12);
      CHECK(exact.meshes[1].linf < 1e-12);
    }
  }
  CHECK(n.wrong_holes == 0);
  CHECK(n.wrong_fringe == 0);
  CHECK(n.blanked_donors == 0);
  CHECK(n.wrong_orphans == 0);
  CHECK(n.wrong_quality == 0);
  CHECK(n.holes > 10 * n_assemblies);
  CHECK(n.fringe > 100 * n_assemblies);
  CHECK(n.orphans > n_assemblies);
}
