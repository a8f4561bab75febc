// Files of surfaces and lines, and named surfaces in files of volumes.
#include "m2m/field_file.hpp"
#include "m2m/io/elements/split_element.hpp"
#include "m2m/io/gmsh/gmsh_reader.hpp"
#include "m2m/io/ranges/mesh_ranges.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/surface.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_vtu.hpp"
#include "tests/m2m/field_values.hpp"
#include "tests/m2m/io/damage.hpp"
#include "tests/m2m/io/gmsh_text.hpp"
#include "tests/m2m/io/new_exodus.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <array>
#include <exodusII.h>
#include <fmt/core.h>

using namespace tess::m2m;
using tess::test::awkward_field, tess::test::bits_of, tess::test::damage_everywhere,
    tess::test::read_all, tess::test::Scratch, tess::test::slurp;

namespace {

/// Elements of one entity of gmsh's model, in some physical groups.
struct Entity {
  int dimension, tag, type;
  std::vector<int> groups;
  std::vector<std::vector<int>> elements;
};

/// A file of version 2.2, 4 or 4.1; the vertices of elements count from 0, their tags from 1.
std::string gmsh_file(const std::string& version, bool binary, const std::vector<Point>& points,
                      const std::vector<Entity>& entities, const std::string& names) {
  const bool legacy = version == "2.2", is_40 = version == "4";
  std::string out = fmt::format("$MeshFormat\n{} {} 8\n", version, binary ? 1 : 0);
  const auto put = [&]<class T>(T value) {
    if (binary) return tess::test::put(out, value);
    out += fmt::format("{} ", value);
  };
  const auto size = [&](std::size_t n) { put(std::uint64_t{n}); };
  const auto tag = [&](int value) {
    is_40 || legacy ? put(value) : size(static_cast<std::size_t>(value));
  };
  if (binary) put(1);
  out += "\n$EndMeshFormat\n$PhysicalNames\n" + names + "$EndPhysicalNames\n";
  if (!legacy) {
    out += "$Entities\n";
    for (int dimension = 0; dimension < 4; ++dimension)
      size(static_cast<std::size_t>(std::ranges::count(entities, dimension, &Entity::dimension)));
    for (const Entity& e : entities) {
      put(e.tag);
      for (int k = 0; k < (e.dimension == 0 && !is_40 ? 3 : 6); ++k) put(0.0);
      size(e.groups.size());
      for (const int group : e.groups) put(-group);
      if (e.dimension > 0) size(1);
      if (e.dimension > 0) put(1);
    }
    out += "\n$EndEntities\n";
  }
  out += "$Nodes\n";
  if (legacy) {
    out += fmt::format("{}\n", points.size());
  } else {
    size(1);
    size(points.size());
    if (!is_40) size(1);
    if (!is_40) size(points.size());
    for (const int x : is_40 ? std::array{1, 3} : std::array{3, 1}) put(x);
    put(0);
    size(points.size());
    for (int v = 1; v <= std::ssize(points) && !is_40; ++v) tag(v);
  }
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (legacy || is_40) tag(static_cast<int>(v + 1));
    for (const double x : points[v]) put(x);
  }
  out += "\n$EndNodes\n$Elements\n";
  std::size_t n = 0;
  for (const Entity& e : entities)
    n += e.elements.size() * (legacy ? std::max<std::size_t>(e.groups.size(), 1) : 1);
  if (legacy) {
    out += fmt::format("{}\n", n);
  } else {
    size(entities.size());
    size(n);
    if (!is_40) size(1);
    if (!is_40) size(n);
  }
  int label = 1;
  for (const Entity& e : entities) {
    if (!legacy) {
      for (const int x : is_40 ? std::array{e.tag, e.dimension} : std::array{e.dimension, e.tag})
        put(x);
      put(e.type);
      size(e.elements.size());
    }
    for (const std::vector<int>& element : e.elements)
      for (const int group : legacy && !e.groups.empty() ? e.groups : std::vector{0}) {
        if (legacy && binary)
          for (const int x : {e.type, 1, 2, label++, group, e.tag}) put(x);
        if (legacy && !binary)
          for (const int x : {label++, e.type, 2, group, e.tag}) put(x);
        if (!legacy) tag(label++);
        for (const int v : element) tag(v + 1);
      }
  }
  return out + "\n$EndElements\n";
}

std::vector<std::vector<int>> corners_of(const std::vector<Tet>& cells, std::size_t first,
                                         std::size_t end, std::size_t n_corners) {
  std::vector<std::vector<int>> out;
  for (std::size_t c = first; c < end; ++c)
    out.emplace_back(cells[c].begin(), cells[c].begin() + static_cast<std::ptrdiff_t>(n_corners));
  return out;
}

const std::vector<Point> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
/// Two quadrilaterals of a square and one beside it, lines below and between them, and a point.
const std::vector<Entity> plane{{0, 1, 15, {}, {{0}}},
                                {1, 1, 1, {4}, {{0, 1}, {1, 4}}},
                                {1, 2, 1, {5}, {{2, 1}, {0, 4}}},
                                {2, 1, 3, {7}, {{3, 2, 1, 0}}},
                                {2, 2, 2, {}, {{1, 4, 5}, {1, 5, 2}}}};
const char* const plane_names = "3\n1 4 \"below\"\n1 5 \"between\"\n2 7 \"left part\"\n";

/// Reads a mesh and its skin back from files of all formats that are written.
void check_round_trip(const TetMesh& mesh) {
  const Scratch scratch;
  const std::array at_vertices{awkward_field("u", mesh.n_points(), 3, 1)};
  const std::array in_cells{awkward_field("q", mesh.n_tets(), 1, 2)};
  for (const char* name : {"out.vtu", "out.exo"}) {
    const std::string path = scratch.path(name);
    CAPTURE(path, mesh.dimension);
    if (path.ends_with("vtu"))
      write_vtu(path, mesh, at_vertices, in_cells);
    else
      write_exodus(path, mesh, at_vertices, in_cells);
    const TetMesh read = read_mesh(path);
    CHECK(read.dimension == mesh.dimension);
    CHECK(read.points == mesh.points);
    CHECK(read.tets == mesh.tets);
    CHECK(skipped_text(read).empty());
    if (path.ends_with("exo")) CHECK(read.blocks == mesh.blocks);
    if (path.ends_with("exo")) CHECK(read.side_sets == mesh.side_sets);
    const FieldFile file(path);
    CHECK(bits_of(file.vertex_field(read, "u", 0).values) == bits_of(at_vertices[0].values));
    CHECK(bits_of(file.tet_field(read, "q", 0).values) == bits_of(in_cells[0].values));
    CHECK(open_ranges(path) == nullptr);
    damage_everywhere(name, slurp(path), 60, 300, read_all);
  }
}

}  // namespace

TEST_CASE("physical groups of gmsh are blocks and side sets, in all versions", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh cube = kuhn_mesh({1});
  std::vector<Tet> bottom;
  for (const Tet& t : skin_of(cube).mesh.tets)
    if (std::ranges::all_of(
            t, [&](VertexId v) { return cube.points[static_cast<std::size_t>(v)][2] == 0; }))
      bottom.push_back(t);
  REQUIRE(bottom.size() == 2);
  const auto& diagonal = cube.tets[0];  // all tetrahedra have the first and the last vertex
  const std::vector<Entity> entities{
      {1, 1, 1, {6}, {{0, 1}}},
      {2, 1, 2, {3, 8}, corners_of(bottom, 0, 2, 3)},
      {2, 2, 2, {8}, {{1, 2, 4}, {diagonal[0], diagonal[1], diagonal[2]}}},
      {2, 3, 2, {}, {{bottom[0][0], bottom[0][1], bottom[0][2]}}},
      {3, 1, 4, {2, 9}, corners_of(cube.tets, 0, 2, 4)},
      {3, 2, 4, {}, corners_of(cube.tets, 2, 3, 4)},
      {3, 3, 4, {2}, corners_of(cube.tets, 3, 6, 4)}};
  const std::string names = "4\n2 3 \"the bottom\"\n2 8 \"more\"\n3 2 \"fluid\"\n3 9 \"twice\"\n";
  for (const char* version : {"2.2", "4", "4.1"})
    for (const bool binary : {false, true}) {
      CAPTURE(version, binary);
      const std::string bytes = gmsh_file(version, binary, cube.points, entities, names);
      const std::string path = scratch.write("groups.msh", bytes);
      const TetMesh mesh = read_mesh(path);
      CHECK(mesh.dimension == 3);
      CHECK(mesh.tets == cube.tets);
      CHECK(mesh.blocks == std::vector<Block>{{2, "fluid", 2}, {3, "", 1}, {4, "fluid", 3}});
      REQUIRE(mesh.side_sets.size() == 2);
      CHECK(mesh.side_sets[0].name == "the bottom");
      CHECK(mesh.side_sets[1].id == 8);
      CHECK(mesh.side_sets[1].entries.size() == 3);
      CHECK(surface_of(mesh, "the bottom").mesh.n_tets() == 2);
      // Left out: the line, a triangle that is no face, one of no group, and copies in 2.2.
      CHECK(skipped_text(mesh) == "1 line2, 2 triangle3, 2 also of group 'twice'");
      damage_everywhere("groups.msh", bytes, 100, 300, read_all);
    }
}

TEST_CASE("a gmsh file without solids is a mesh of surfaces or of lines", "[m2m][io]") {
  const Scratch scratch;
  for (const char* version : {"2.2", "4", "4.1"})
    for (const bool binary : {false, true}) {
      CAPTURE(version, binary);
      const std::string bytes = gmsh_file(version, binary, square, plane, plane_names);
      const std::string path = scratch.write("plane.msh", bytes);
      const TetMesh mesh = read_mesh(path);
      CHECK(mesh.dimension == 2);
      CHECK(mesh.tets == std::vector<Tet>{{0, 3, 2, 2}, {0, 2, 1, 1}, {1, 4, 5, 5}, {1, 5, 2, 2}});
      CHECK(mesh.element_of_tet == std::vector<GlobalId>{0, 0, 1, 2});
      CHECK(mesh.blocks == std::vector<Block>{{7, "left part", 2}, {8, "", 2}});
      CHECK(mesh.side_sets ==
            std::vector<SideSet>{{4, "below", {{1, 3}, {2, 1}}, {}}, {5, "between", {{1, 2}}, {}}});
      CHECK(skipped_text(mesh) == "1 line2, 1 point");  // the line that is no edge
      CHECK(open_ranges(path) == nullptr);
      CHECK(surface_of(mesh, "below").mesh.dimension == 1);
      damage_everywhere("plane.msh", bytes, 60, 200, read_all);
      const TetMesh lines = read_gmsh("lines", bytes, 1);
      CHECK(lines.tets == std::vector<Tet>{{0, 1, 1, 1}, {1, 4, 4, 4}, {2, 1, 1, 1}, {0, 4, 4, 4}});
      CHECK(lines.blocks == std::vector<Block>{{4, "below", 2}, {5, "between", 2}});
    }
  const Entity nine{2, 1, 10, {}, {{0, 1, 2, 3, 4, 5, 0, 1, 2}}};
  CHECK_THROWS_WITH(
      read_mesh(scratch.write("nine.msh", gmsh_file("4.1", false, square, {nine}, "0\n"))),
      Contains("has elements of type quad9; of surfaces, triangle3, triangle6 and quad4 are"));
}

TEST_CASE("meshes of triangles and of edges are written and read back bit for bit", "[m2m][io]") {
  const TetMesh cube = kuhn_mesh({2, 0.2});
  TetMesh wall = skin_of(cube).mesh;
  wall.side_sets = {{3, "some", {{0, 1}, {4, 3}, {7, 2}}, {}}};
  check_round_trip(wall);
  wall.tets.resize(20);
  wall.blocks.clear();
  TetMesh rim = skin_of(wall).mesh;
  rim.side_sets = {{2, "ends", {{0, 1}, {1, 2}}, {}}};
  check_round_trip(rim);
}

TEST_CASE("shells, quadrilaterals and six-node triangles of ExodusII are split", "[m2m][io]") {
  const Scratch scratch;
  const std::array<double, 8> x{0, 1, 1, 0, 2, 2, 0.5, 1}, y{0, 0, 1, 1, 0, 1, 0, 0.5};
  const auto file = [&](int n_axes, const char* quad, const char* triangle) {
    const std::string path = scratch.path("plane.exo");
    const int id = tess::test::new_exodus(path);
    ex_put_init(id, "plane", n_axes, 8, 4, 3, 0, 1);
    ex_put_coord(id, x.data(), y.data(), n_axes == 3 ? x.data() : nullptr);
    tess::test::put_block(id, 1, "BAR2", 1, {1, 2});
    tess::test::put_block(id, 2, quad, 1, {4, 3, 2, 1});
    tess::test::put_block(id, 3, triangle, 2, {2, 5, 3, 5, 6, 3});
    // The lower edge of the square, an edge of the first triangle, and the bar.
    const int quad_first = std::string(quad).starts_with("SHELL") ? 2 : 0;
    const int tri_first = n_axes == 3 ? 2 : 0;
    const std::array<int, 4> elements{2, 3, 1, 2}, sides{quad_first + 3, tri_first + 1, 1, 1};
    ex_put_set_param(id, EX_SIDE_SET, 9, 4, 0);
    ex_put_set(id, EX_SIDE_SET, 9, elements.data(), sides.data());
    ex_close(id);
    return path;
  };
  for (const auto& [n_axes, quad] : {std::pair{2, "QUAD4"}, {3, "SHELL4"}, {3, "QUAD"}}) {
    CAPTURE(n_axes, quad);
    const TetMesh mesh = read_mesh(file(n_axes, quad, "TRI3"));
    CHECK(mesh.dimension == 2);
    CHECK(mesh.tets == std::vector<Tet>{{0, 3, 2, 2}, {0, 2, 1, 1}, {1, 4, 2, 2}, {4, 5, 2, 2}});
    CHECK(mesh.points[5] == Point{2, 1, n_axes == 3 ? 2.0 : 0.0});
    CHECK(mesh.blocks == std::vector<Block>{{2, "", 2}, {3, "", 2}});
    CHECK(mesh.skipped.front() == Skipped{"BAR2", 1});
    REQUIRE(mesh.side_sets.size() == 1);
    const bool is_shell = std::string(quad) == "SHELL4";
    std::vector<Side> sides{{1, 3}, {2, 1}};
    if (!is_shell) sides.push_back({0, 2});  // side 1 of a quadrilateral is an edge
    CHECK(mesh.side_sets[0].entries == sides);
    CHECK(skipped_text(mesh) == (is_shell ? "1 BAR2, 1 face in a side set" : "1 BAR2"));
  }
  CHECK_THROWS_WITH(read_mesh(file(2, "QUAD4", "TRI4")),
                    Contains("TRI3, TRI6, QUAD4, SHELL3 and SHELL4 are supported"));
  std::vector<Tet> cells;
  split_element(ElementType::tri6, std::array{0, 1, 2, 3, 4, 5}, cells);
  CHECK(cells == std::vector<Tet>{{0, 3, 5, 5}, {3, 1, 4, 4}, {5, 4, 2, 2}, {3, 4, 5, 5}});
  split_element(ElementType::quad4, std::array{1, 2, 2, 0}, cells);  // a triangle
  CHECK(cells.size() == 5);
}
