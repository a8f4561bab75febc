#include "m2m/overset/boundary.hpp"

#include "apps/overset/body.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/overset/wall.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

using namespace tess;
using namespace tess::m2m;

TEST_CASE("the cavity of a mesh is its wall, the rest of its boundary is outer", "[m2m][overset]") {
  for (const char* name : {"ball:3", "box:4", "star:5", "torus:3"}) {
    INFO(name);
    overset::Body body = overset::parse_body(name);
    body.n_layers = 2;
    TetMesh mesh = overset::mesh_around(body);
    CHECK(validate(mesh).n_inverted == 0);
    for (const double scale : {1.0, 1e90, 1e-70}) {
      TetMesh scaled = mesh;
      for (Point& p : scaled.points)
        for (double& x : p) x *= scale;
      for (std::size_t t = 0; t < scaled.n_tets(); t += 2)
        std::swap(scaled.tets[t][0], scaled.tets[t][1]);  // inverted: it does not matter
      const OversetBoundary boundary = overset_boundary(scaled);
      const std::size_t n = mesh.n_points() / 3;  // points of a layer
      CHECK(boundary.wall.size() == overset::surface_of(body).size());
      for (std::size_t v = 0; v < mesh.n_points(); ++v)
        CHECK(boundary.on_outer[v] == (v >= 2 * n ? 1 : 0));
      const Wall wall(scaled.points, boundary.wall);
      CHECK(wall.rim().n_edges == 0);
      CHECK(wall.n_triangles() == boundary.wall.size());
    }
  }
}

TEST_CASE("a mesh without a cavity has no wall", "[m2m][overset]") {
  const TetMesh mesh = kuhn_mesh({3});
  const OversetBoundary boundary = overset_boundary(mesh);
  CHECK(boundary.wall.empty());
  CHECK(std::count(boundary.on_outer.begin(), boundary.on_outer.end(), 1) == 64 - 8);
}

TEST_CASE("a side set names the wall", "[m2m][overset]") {
  TetMesh mesh = kuhn_mesh({1});
  SideSet below{.id = 1, .name = "below"};
  // Sides of ExodusII: corners of side 1 to 4.
  constexpr std::array<std::array<std::size_t, 3>, 4> sides{
      {{0, 1, 3}, {1, 2, 3}, {0, 2, 3}, {0, 1, 2}}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t s = 0; s < 4; ++s) {
      const auto z = [&](std::size_t i) {
        return mesh.points[static_cast<std::size_t>(mesh.tets[t][sides[s][i]])][2];
      };
      if (z(0) == 0 && z(1) == 0 && z(2) == 0)
        below.entries.push_back({static_cast<GlobalId>(t), static_cast<std::int32_t>(s + 1)});
    }
  mesh.side_sets.push_back(below);
  const OversetBoundary boundary = overset_boundary(mesh, "below");
  REQUIRE(boundary.wall.size() == 2);
  for (const auto& triangle : boundary.wall)
    for (const VertexId v : triangle) CHECK(mesh.points[static_cast<std::size_t>(v)][2] == 0);
  CHECK_THROWS_WITH(overset_boundary(mesh, "above"), Contains("no side set above; it has below"));
  mesh.side_sets.push_back({.id = 4, .name = "", .entries = {below.entries[0]}});
  CHECK(overset_boundary(mesh, "4").wall.size() == 1);
  CHECK_THROWS_WITH(overset_boundary(mesh, "5"), Contains("5; it has below, 4"));
}
