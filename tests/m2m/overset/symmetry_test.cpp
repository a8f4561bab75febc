#include "m2m/overset/symmetry.hpp"

#include "apps/overset/body.hpp"
#include "m2m/overset.hpp"
#include "tests/m2m/overset/turned.hpp"
#include "tests/m2m/overset/voxel_body.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

using namespace tess;
using namespace tess::m2m;
using tess::test::VoxelBody;

namespace {

constexpr int end_of_body = VoxelBody::n;

/// The side of the cube of the body across an axis: its low or its high one.
SymmetryPlane side(std::size_t axis, bool is_high) {
  SymmetryPlane plane{{}, is_high ? -end_of_body : 0.0, 1e-9};
  plane.normal[axis] = is_high ? -1 : 1;
  return plane;
}

/// The mirror image of the cube at an index, if the planes give it one.
std::array<int, 3> folded(std::array<int, 3> cube, const std::vector<SymmetryPlane>& planes) {
  for (const SymmetryPlane& plane : planes)
    for (std::size_t k = 0; k < 3; ++k) {
      if (plane.normal[k] > 0 && cube[k] < 0) cube[k] = -1 - cube[k];
      if (plane.normal[k] < 0 && cube[k] >= end_of_body) cube[k] = 2 * end_of_body - 1 - cube[k];
    }
  return cube;
}

/// The answer for the point (x, y, z) / 2 in the body with its mirror images.
Containment mirrored_answer(const VoxelBody& body, const std::array<int, 3>& twice,
                            const std::vector<SymmetryPlane>& planes) {
  bool all = true, any = false;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<int, 3> cube{};
    for (std::size_t k = 0; k < 3; ++k)
      cube[k] = (twice[k] + 20 - ((corner >> k) & 1) * (twice[k] % 2 == 0 ? 1 : 0)) / 2 - 10;
    cube = folded(cube, planes);
    const bool is_filled = body.at(cube[0], cube[1], cube[2]);
    all = all && is_filled;
    any = any || is_filled;
  }
  return all ? Containment::inside : any ? Containment::on_wall : Containment::outside;
}

/// The wall of the body without its triangles in the planes.
test::VoxelSurface open_surface(const VoxelBody& body, std::mt19937& random,
                                const std::vector<SymmetryPlane>& planes) {
  test::VoxelSurface surface(body, random, [](int x, int y, int z) {
    return Point{double(x), double(y), double(z)};
  });
  std::erase_if(surface.triangles, [&](const auto& t) {
    return std::any_of(planes.begin(), planes.end(), [&](const SymmetryPlane& plane) {
      return std::all_of(t.begin(), t.end(), [&](VertexId v) {
        return plane.holds(surface.points[static_cast<std::size_t>(v)]);
      });
    });
  });
  return surface;
}

std::vector<std::vector<SymmetryPlane>> plane_sets() {
  return {{side(2, false)},
          {side(0, true)},
          {side(2, false), side(2, true)},
          {side(1, false), side(2, true)},
          {side(0, true), side(1, false), side(2, false)}};
}

}  // namespace

TEST_CASE("a body of cubes on planes of symmetry holds the points that it holds with its images",
          "[m2m][overset]") {
  std::mt19937 random(5);
  std::size_t n_wrong = 0, n_wrong_turned = 0, n_inside_in_plane = 0, n_on_symmetry = 0;
  for (int k = 0; k < 20; ++k)
    for (const auto& planes : plane_sets()) {
      const VoxelBody body(random, k % 2 == 0 ? 0.3 : 0.7);
      test::VoxelSurface surface = open_surface(body, random, planes);
      const Wall wall(surface.points, surface.triangles, planes);
      CHECK(wall.rim().n_edges == 0);
      n_on_symmetry += wall.rim().n_on_symmetry;
      // Turned, points in planes and planes are rounded.
      const RigidMotion turn{.axis = {1, 2, double(k)}, .angle = 0.1 + k, .translation = {7, 5, 3}};
      std::vector<SymmetryPlane> turned_planes;
      for (const SymmetryPlane& plane : planes) turned_planes.push_back(test::turned(plane, turn));
      move_points(surface.points, turn);
      const Wall turned(surface.points, surface.triangles, turned_planes);
      for (int at = 0; at < 11 * 11 * 11; ++at) {
        const std::array<int, 3> twice{at % 11 - 1, at / 11 % 11 - 1, at / 121 - 1};
        std::array<Point, 1> p{Point{0.5 * twice[0], 0.5 * twice[1], 0.5 * twice[2]}};
        const auto any = [&](auto test) { return std::any_of(planes.begin(), planes.end(), test); };
        if (any([&](const SymmetryPlane& plane) { return plane.is_beyond(p[0]); })) continue;
        const bool is_in_plane = any([&](const SymmetryPlane& plane) { return plane.holds(p[0]); });
        const Containment answer = mirrored_answer(body, twice, planes);
        if (wall.locate(p[0]) != answer) ++n_wrong;
        if (is_in_plane && answer == Containment::inside) ++n_inside_in_plane;
        move_points(p, turn);
        if (answer != Containment::on_wall && turned.locate(p[0]) != answer) ++n_wrong_turned;
      }
    }
  CHECK(n_wrong == 0);
  CHECK(n_wrong_turned == 0);
  CHECK(n_inside_in_plane > 500);
  CHECK(n_on_symmetry > 100);
}

TEST_CASE("walls that do not fit their planes of symmetry are refused", "[m2m][overset]") {
  std::mt19937 random(7);
  const VoxelBody body(random, 1);
  const std::vector<SymmetryPlane> one{side(2, false)}, two{side(1, false), side(2, false)};
  const auto half = open_surface(body, random, one), quarter = open_surface(body, random, two);
  const auto build = [](const test::VoxelSurface& surface,
                        const std::vector<SymmetryPlane>& planes) {
    return Wall(surface.points, surface.triangles, planes);
  };
  CHECK(build(half, one).rim().n_on_symmetry == 1);
  CHECK(build(half, two).rim().n_on_symmetry == 1);  // none stands on the other
  CHECK_THROWS_WITH(build(quarter, {}),
                    Contains("the wall is open") && Contains("planes of symmetry"));
  CHECK_THROWS_WITH(build(quarter, one), Contains("in part only") && Contains("it leaves z=0"));
  const std::vector<SymmetryPlane> facing{side(1, false), side(2, false), side(2, true)};
  CHECK_THROWS_WITH(build(open_surface(body, random, facing), facing),
                    Contains("face each other, among y=0,z=0,z=4"));
  test::VoxelSurface turned = half;
  for (std::size_t t = 0; t < turned.triangles.size(); t += 2)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  CHECK_THROWS_WITH(build(turned, one), Contains("not oriented alike"));
  for (auto& t : turned.triangles = half.triangles) std::swap(t[0], t[1]);
  CHECK(build(turned, one).locate({2, 2, 0}) == Containment::inside);  // all of them inwards
}

TEST_CASE("faces of a half body's mesh in planes of symmetry are neither wall nor outer boundary",
          "[m2m][overset]") {
  const std::vector<SymmetryPlane> all{
      {{1, 0, 0}, 0.5, 1e-9}, {{0, -1, 0}, -1, 1e-9}, {{0, 0, 1}, 0, 1e-9}};
  for (const char* name : {"ball:4", "box:2", "star:6", "torus:4"})
    for (std::size_t n_planes = 1; n_planes <= all.size(); ++n_planes) {
      INFO(name << " on " << n_planes);
      const std::span planes = std::span(all).first(n_planes);
      overset::Body body = overset::parse_body(name, planes);
      body.n_layers = 2;
      const TetMesh mesh = overset::mesh_around(body);
      CHECK(validate(mesh).n_inverted == 0);
      const OversetBoundary boundary = overset_boundary(mesh, {}, planes);
      CHECK(boundary.wall.size() == overset::surface_of(body).size());
      const std::size_t n = mesh.n_points() / 3;  // points of a layer
      for (std::size_t v = 0; v < mesh.n_points(); ++v)
        CHECK(boundary.on_outer[v] == (v >= 2 * n ? 1 : 0));
      CHECK(Wall(mesh.points, boundary.wall, planes).rim().n_on_symmetry >= 1);
      for (const std::size_t n_edges : rim_edges_in(mesh.points, boundary.wall, planes))
        CHECK(n_edges > 0);
    }
  CHECK_THROWS_WITH(mesh_around(overset::parse_body("ball:5", all)),
                    Contains("give an even number"));
}

TEST_CASE("a plane of symmetry is a side of the domain, and points go onto it", "[m2m][overset]") {
  std::vector<Point> points{{0, 0, -2e-10}, {1, 2, 0}, {0.5, 1, 3}, {1, 0, 1e-10}};
  const SymmetryPlane low = symmetry_plane({0, 0, 2}, 0, points);
  CHECK(low == SymmetryPlane{{0, 0, 1}, 0, 1e-9 * points[2][2] + 1e-9 * 2e-10});
  CHECK(symmetry_plane({0, 1, 0}, 2, points) == SymmetryPlane{{0, -1, 0}, -2, low.tolerance});
  CHECK(text_of(symmetry_plane({0, 1, 0}, 2, points)) == "y=2");
  CHECK(text_of(SymmetryPlane{{0.6, 0.8, 0}, 2}) == "0.6:0.8:0=2");
  project(points, {&low, 1});
  CHECK(points == std::vector<Point>{{0, 0, 0}, {1, 2, 0}, {0.5, 1, 3}, {1, 0, 0}});
  CHECK_THROWS_WITH(symmetry_plane({0, 0, 1}, 1, points),
                    Contains("z=1 is no plane of symmetry") && Contains("reaches 1 to one side"));
  CHECK_THROWS_WITH(symmetry_plane({0, 0, 1}, -1, points), Contains("the domain ends 1 from it"));
  CHECK_THROWS_WITH(symmetry_plane({}, 1, points), Contains("needs a length"));
}
