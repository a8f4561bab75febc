#include "m2m/surface.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/surface/sides.hpp"
#include "tests/m2m/element_meshes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using namespace tess::m2m;
using tess::test::message_of;

namespace {

Point at(const TetMesh& mesh, VertexId v) {
  return mesh.points[static_cast<std::size_t>(v)];
}

/// Twice the normals' integral, and six times the volume that the triangles enclose.
struct Flux {
  Point normal{};
  double volume = 0, area = 0;
};
Flux flux_of(const TetMesh& mesh) {
  Flux out;
  for (const Tet& t : mesh.tets) {
    const Point a = at(mesh, t[0]);
    const Point n = cross(difference(at(mesh, t[1]), a), difference(at(mesh, t[2]), a));
    for (std::size_t k = 0; k < 3; ++k) out.normal[k] += n[k];
    out.volume += dot(a, n);
    out.area += std::sqrt(dot(n, n));
  }
  return out;
}

/// A cube of 2³ bricks with a named side at x = 0 and blocks for its lower and upper half.
TetMesh named_cube() {
  TetMesh mesh = kuhn_mesh({2});
  mesh.name = "cube";
  std::ranges::stable_partition(mesh.tets, [&](const Tet& t) {
    return std::ranges::all_of(t, [&](VertexId v) { return at(mesh, v)[2] <= 0.5; });
  });
  mesh.blocks = {{7, "lower", 24}, {3, "", 24}};
  SideSet inlet{4, "inlet", {}, {}};
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    for (std::int32_t s = 1; s <= 4; ++s)
      if (std::ranges::all_of(side_of(mesh.tets[t], 3, s),
                              [&](VertexId v) { return at(mesh, v)[0] == 0; }))
        inlet.entries.push_back({static_cast<GlobalId>(t), s});
  inlet.entries.push_back(inlet.entries.front());
  mesh.side_sets = {inlet, {3, "", {inlet.entries[0]}, {}}, {5, "none", {}, {}}};
  return mesh;
}

}  // namespace

TEST_CASE("the skin of a mesh of any elements is closed, and encloses its volume",
          "[m2m][surface]") {
  for (const ElementType type : tess::test::all_element_types) {
    TetMesh mesh = tess::test::element_mesh(type, 3);
    CAPTURE(name_of(type));
    for (std::size_t t = 0; t < mesh.n_tets(); t += 3) std::swap(mesh.tets[t][0], mesh.tets[t][1]);
    double volume = 0;
    for (std::size_t t = 0; t < mesh.n_tets(); ++t) volume += std::abs(signed_volume(mesh, t));
    mesh.tets.push_back({0, 1, 2, 1});  // a flat tetrahedron has no sides
    const SurfaceMesh skin = skin_of(mesh);
    CHECK(skin.mesh.dimension == 2);
    const Flux flux = flux_of(skin.mesh);
    CHECK(flux.volume / 6 == Approx(volume).epsilon(1e-13));  // inwards it would be negative
    for (const double n : flux.normal) CHECK(std::abs(n) < 1e-13);
    std::map<std::pair<VertexId, VertexId>, int> edges;
    for (const Tet& t : skin.mesh.tets)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, n] : edges) {
      CHECK(n == 1);
      CHECK(edges.contains({edge.second, edge.first}));
    }
    CHECK(message_of([&] { (void)skin_of(skin.mesh); }) ==
          std::string("mesh ") + name_of(type) +
              ":skin: its part 'skin' is empty; name another "
              "part, or none");
  }
}

TEST_CASE("a side set, a block or the skin is a mesh of triangles that knows its volume",
          "[m2m][surface]") {
  const TetMesh mesh = named_cube();
  const SurfaceMesh inlet = surface_of(mesh, "inlet");
  CHECK(inlet.mesh.name == "cube:inlet");
  CHECK(inlet.mesh.n_tets() == 8);  // of which one is listed twice
  CHECK(inlet.mesh.n_points() == 9);
  CHECK(inlet.mesh.blocks == std::vector<Block>{{4, "inlet", 8}});
  CHECK(flux_of(inlet.mesh).normal == Point{-2, 0, 0});
  CHECK(std::ranges::is_sorted(inlet.vertex_of_point));
  Field field{"f", 2, {}};
  for (std::size_t v = 0; v < mesh.n_points(); ++v)
    field.values.insert(field.values.end(), {mesh.points[v][1], mesh.points[v][2]});
  const Field there = rows_of(field, inlet.vertex_of_point);
  for (std::size_t v = 0; v < inlet.mesh.n_points(); ++v) {
    CHECK(inlet.mesh.points[v] == Point{0, there.values[2 * v], there.values[2 * v + 1]});
    CHECK(inlet.mesh.points[v] == at(mesh, inlet.vertex_of_point[v]));
  }
  for (std::size_t c = 0; c < inlet.mesh.n_tets(); ++c)
    for (const VertexId v : inlet.mesh.tets[c])
      CHECK(std::ranges::count(mesh.tets[static_cast<std::size_t>(inlet.tet_of_cell[c])],
                               inlet.vertex_of_point[static_cast<std::size_t>(v)]) == 1);
  CHECK(surface_of(mesh, "4").mesh.tets == inlet.mesh.tets);
  const Flux lower = flux_of(surface_of(mesh, "lower").mesh);
  CHECK(lower.volume / 6 == 0.5);
  CHECK(lower.area / 2 == 4);  // the half cube's, with what it shares with the other half
  CHECK(surface_of(mesh, "3").mesh.n_tets() == 1);         // the side set comes first
  CHECK(surface_of(mesh, "block 3").mesh.n_tets() == 32);  // of the block
  CHECK(surface_of(mesh, "7").mesh.n_tets() == 32);
}

TEST_CASE("the edges and the blocks of a mesh of triangles are meshes, too", "[m2m][surface]") {
  const TetMesh mesh = named_cube();
  TetMesh inlet = surface_of(mesh, "inlet").mesh;
  inlet.side_sets = {{1, "rim", {{0, 1}, {0, 3}}, {}}};
  const SurfaceMesh edges = skin_of(inlet);
  CHECK(edges.mesh.dimension == 1);
  CHECK(edges.mesh.n_tets() == 8);
  CHECK(edges.mesh.n_points() == 8);
  double length = 0;
  for (const Tet& edge : edges.mesh.tets) {
    CHECK(edge[1] == edge[3]);
    const Point d = difference(at(edges.mesh, edge[1]), at(edges.mesh, edge[0]));
    length += std::sqrt(dot(d, d));
  }
  CHECK(length == 4);
  const SurfaceMesh rim = surface_of(inlet, "rim");
  CHECK(rim.mesh.n_tets() == 2);
  CHECK(rim.mesh.n_points() == 3);
  CHECK(rim.tet_of_cell == std::vector<GlobalId>{0, 0});
  const SurfaceMesh same = surface_of(inlet, "inlet");
  CHECK(same.mesh.tets == inlet.tets);
  CHECK(same.mesh.dimension == 2);
  CHECK_THROWS_WITH(skin_of(edges.mesh),
                    "mesh cube:inlet:skin: a mesh of edges has no skin; name a block, or none");
  CHECK(surface_of(edges.mesh, "block 1").mesh.tets == edges.mesh.tets);
}

TEST_CASE("a part that a mesh does not have is refused with those that it has", "[m2m][surface]") {
  TetMesh mesh = named_cube();
  for (const char* part : {"foo", "", "8", "block 4", "block x"})
    CHECK(message_of([&] { (void)surface_of(mesh, part); }) ==
          std::string("mesh cube has no part '") + part +
              "': there are inlet, 3, none (side sets), block 7 'lower', block 3, skin");
  CHECK(message_of([&] { (void)surface_of(mesh, "none"); }) ==
        "mesh cube: its part 'none' is empty; name another part, or none");
  mesh.blocks.clear();
  mesh.side_sets.resize(1);
  CHECK_THROWS_WITH(surface_of(mesh, "lower"), Contains("there are inlet (side set), skin"));
}

TEST_CASE("side sets of real meshes lie on their skin", "[m2m][surface][.][shared_data]") {
  for (const char* file : {"nalu/3d_tet4_pipe.exo", "nalu/3d_hex8_pipe.exo"}) {
    const TetMesh mesh = read_mesh(tess::test::shared_data(file));
    std::size_t n_sides = 0;
    double volume = 0;
    for (std::size_t t = 0; t < mesh.n_tets(); ++t) volume += std::abs(signed_volume(mesh, t));
    const SurfaceMesh skin = skin_of(mesh);
    CHECK(flux_of(skin.mesh).volume / 6 == Approx(volume).epsilon(1e-12));
    double area = 0;
    for (const SideSet& set : mesh.side_sets) {
      const SurfaceMesh part =
          surface_of(mesh, set.name.empty() ? std::to_string(set.id) : set.name);
      n_sides += part.mesh.n_tets();
      area += flux_of(part.mesh).area;
    }
    CHECK(n_sides == skin.mesh.n_tets());
    CHECK(area == Approx(flux_of(skin.mesh).area).epsilon(1e-12));
  }
}
