#include "m2m/io/gmsh/gmsh_reader.hpp"
#include "m2m/io/ranges/mesh_ranges.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/rows/interpolate/native_element.hpp"
#include "m2m/write_exodus.hpp"
#include "tests/m2m/io/damage.hpp"
#include "tests/m2m/io/gmsh_text.hpp"
#include "tests/m2m/io/new_exodus.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"
#include "tests/support/shared_data.hpp"

#include <array>
#include <exodusII.h>

using namespace tess::m2m;
using tess::test::as_gmsh, tess::test::damage_everywhere, tess::test::message_of,
    tess::test::Scratch, tess::test::shared_data, tess::test::slurp;

namespace {

const tess::test::ReadFile as_mesh = [](const std::string& path) { (void)read_mesh(path); };

/// A mesh with blocks and sets of all kinds.
TetMesh grouped_mesh() {
  TetMesh mesh = kuhn_mesh({2, 0.1});
  mesh.blocks = {{7, "fluid", 40}, {3, "", 0}, {12, "a name that is longer than 32 characters", 8}};
  mesh.side_sets = {{4, "inlet", {{0, 1}, {47, 4}}, {}},
                    {9, "", {{3, 2}}, {0.5, 1.5, 2.5}},
                    {10, "empty", {}, {}}};
  mesh.node_sets = {{5, "fixed", {26, 0, 13}, {1, 2, 3}}, {6, "", {1}, {}}};
  return mesh;
}

/// An ExodusII file of tetrahedra (with this type name and number of vertices) between blocks of
/// triangles and bars, with side sets of both.
std::string mixed_file(const Scratch& scratch, const char* tet_type, int n_tet_vertices = 4) {
  const std::string path = scratch.path("mixed.exo");
  const int id = tess::test::new_exodus(path);
  const std::array<double, 5> x{0, 1, 0, 0, 1}, y{0, 0, 1, 0, 1}, z{0, 0, 0, 1, 1};
  ex_put_init(id, "mixed", 3, 5, 7, 4, 1, 2);
  ex_put_coord(id, x.data(), y.data(), z.data());
  std::vector<int> first{1, 2, 3, 4}, second{2, 3, 4, 5};
  first.resize(static_cast<std::size_t>(n_tet_vertices), 1);
  second.resize(static_cast<std::size_t>(n_tet_vertices), 1);
  tess::test::put_block(id, 20, "tri3", 2, {1, 2, 3, 1, 2, 4});
  tess::test::put_block(id, 21, tet_type, 1, first);
  tess::test::put_block(id, 22, "BAR2", 3, {1, 2, 2, 3, 3, 4});
  tess::test::put_block(id, 23, tet_type, 1, second);
  const std::array<int, 2> elements{3, 7}, sides{1, 4}, mixed{1, 7}, mixed_sides{1, 2};
  ex_put_set_param(id, EX_SIDE_SET, 1, 2, 0);
  ex_put_set(id, EX_SIDE_SET, 1, elements.data(), sides.data());
  ex_put_set_param(id, EX_SIDE_SET, 2, 2, 0);
  ex_put_set(id, EX_SIDE_SET, 2, mixed.data(), mixed_sides.data());
  const int vertex = 5;
  ex_put_set_param(id, EX_NODE_SET, 8, 1, 0);
  ex_put_set(id, EX_NODE_SET, 8, &vertex, nullptr);
  ex_close(id);
  return path;
}

}  // namespace

TEST_CASE(
    "gmsh files of all versions and modes give the same mesh, with gaps between tags or a byte "
    "order mark",
    "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({2, 0.1});
  for (const bool binary : {false, true})
    for (const char* version : {"2", "2.0", "2.1", "2.2", "4.1"}) {
      CAPTURE(version, binary);
      std::string text = as_gmsh(mesh, version[0] == '2', binary, 1);
      text.replace(text.find('\n') + 1, 3, version);
      for (const std::uint64_t gap : {1000U, 30000000U}) {  // between tags
        const TetMesh read = read_gmsh("test", as_gmsh(mesh, version[0] == '2', binary, gap));
        CHECK(read.points == mesh.points);
        CHECK(read.tets == mesh.tets);
      }
      for (const char* mark : {"", "\xEF\xBB\xBF"}) {
        const std::string path = scratch.write("a.msh", mark + text);
        const TetMesh read = read_mesh(path);
        CHECK(read.points == mesh.points);
        CHECK(read.tets == mesh.tets);
        const auto ranges = open_ranges(path);
        CHECK((ranges != nullptr) == (binary && version[0] == '4'));
        std::vector<Tet> tets(mesh.n_tets());
        if (ranges != nullptr) ranges->tets(0, tets);
        if (ranges != nullptr) CHECK(tets == mesh.tets);
      }
    }
  std::string other = as_gmsh(mesh, false, false, 1);
  other.replace(other.find("4.1"), 3, "3.0");
  CHECK_THROWS_WITH(read_mesh(scratch.write("a.msh", other)),
                    Contains("is MSH 3; only 2.0 to 2.2, 4.0 and 4.1 are supported"));
}

TEST_CASE("sections of gmsh that are repeated are all read, and those of other kinds are named",
          "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({2, 0.1});
  // The points in two sections, and the tetrahedra in two behind each.
  const auto text = [&](bool legacy, bool binary) {
    TetMesh part = mesh;
    std::string out;
    const std::ptrdiff_t n = std::ssize(mesh.tets) / 2;
    for (const bool is_first : {true, false}) {
      part.tets.assign(mesh.tets.begin() + (is_first ? 0 : n),
                       mesh.tets.end() - (is_first ? n : 0));
      std::string file = as_gmsh(part, legacy, binary, 7);
      // Both halves use all points, which the file has once.
      out += is_first ? file : file.substr(file.find("$Elements"));
    }
    return out;
  };
  for (const bool legacy : {false, true})
    for (const bool binary : {false, true}) {
      CAPTURE(legacy, binary);
      const TetMesh read = read_mesh(scratch.write("twice.msh", text(legacy, binary)));
      CHECK(read.points == mesh.points);
      CHECK(read.tets == mesh.tets);
      CHECK(skipped_text(read) == "2 point");
      CHECK(open_ranges(scratch.path("twice.msh")) == nullptr);  // as it would lack a half
    }
  const std::string nodes_twice =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
      "$Elements\n0\n$EndElements\n$Nodes\n1\n4 0 0 1\n$EndNodes\n"
      "$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n";
  const std::string view = "$ElementNodeData\n0\n$EndElementNodeData\n";
  const TetMesh read = read_mesh(scratch.write("nodes.msh", nodes_twice + view + view));
  CHECK(read.tets == std::vector<Tet>{{0, 1, 2, 3}});
  CHECK(skipped_text(read) == "2 section $ElementNodeData");
  const std::string binary = as_gmsh(mesh, false, true, 1);
  CHECK(open_ranges(scratch.write("one.msh", binary)) != nullptr);
  CHECK(open_ranges(scratch.write("one.msh", binary + view)) == nullptr);
  CHECK_THAT(
      message_of([&] {
        (void)read_mesh(scratch.write("again.msh", nodes_twice + "$Nodes\n1\n2 9 9 9\n$EndNodes\n"
                                                                 "$Elements\n0\n$EndElements\n"));
      }),
      Contains("node tag 2 occurs twice"));
}

TEST_CASE("a written mesh is read back with its fields, and no other file remains", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  const Field scalar =
      sample(mesh, "temperature_of_the_whole_fluid_domain", make_formula("sin", bounds(mesh)));
  Field vector{"velocity", 3, std::vector<double>(3 * mesh.n_points(), 0.5)};
  vector.values[4] = -2;
  const Field part{"part", 1, std::vector<double>(mesh.n_tets(), 3)};
  const std::string path = scratch.path("out.exo");
  write_exodus(path, mesh, std::array{scalar, vector}, std::array{part});
  write_exodus(path, mesh, std::array{scalar, vector}, std::array{part});  // overwrites it
  CHECK(scratch.n_files() == 1);
  const TetMesh read = read_mesh(path);
  CHECK(read.points == mesh.points);
  CHECK(read.tets == mesh.tets);

  int compute = 8, stored = 0;
  float version = 0;
  const int id = ex_open(path.c_str(), EX_READ, &compute, &stored, &version);
  REQUIRE(id >= 0);
  ex_set_max_name_length(id, 64);
  CHECK(ex_inquire_int(id, EX_INQ_TIME) == 1);
  int n_variables = 0;
  ex_get_variable_param(id, EX_NODAL, &n_variables);
  CHECK(n_variables == 4);
  std::array<char, 256> name{};
  ex_get_variable_name(id, EX_NODAL, 1, name.data());
  CHECK(name.data() == scalar.name);
  ex_get_variable_name(id, EX_NODAL, 3, name.data());
  CHECK(std::string(name.data()) == "velocity_y");
  std::vector<double> values(mesh.n_points());
  ex_get_var(id, 1, EX_NODAL, 1, 1, static_cast<std::int64_t>(values.size()), values.data());
  CHECK(values == scalar.values);
  ex_get_var(id, 1, EX_NODAL, 3, 1, static_cast<std::int64_t>(values.size()), values.data());
  CHECK(values[1] == -2);
  ex_close(id);

  CHECK_THROWS_WITH(write_exodus(scratch.path("no/such/folder.exo"), mesh, {}),
                    Contains("no/such/folder.exo: cannot be written"));
  CHECK(scratch.n_files() == 1);
}

TEST_CASE("blocks, side sets and node sets are read back with numbers, names and factors",
          "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = grouped_mesh();
  (void)validate(mesh);
  Field part{"part", 1, std::vector<double>(mesh.n_tets())};
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) part.values[t] = static_cast<double>(t);
  const std::string path = scratch.path("out.exo");
  write_exodus(path, mesh, {}, std::array{part});
  TetMesh read = read_mesh(path);
  CHECK(read.tets == mesh.tets);
  CHECK(read.blocks == std::vector{mesh.blocks[0], mesh.blocks[2]});  // without the empty one
  CHECK(read.side_sets == mesh.side_sets);
  CHECK(read.node_sets == mesh.node_sets);

  int compute = 8, stored = 0;
  float version = 0;
  const int id = ex_open(path.c_str(), EX_READ, &compute, &stored, &version);
  REQUIRE(id >= 0);
  std::vector<double> values(8);
  ex_get_var(id, 1, EX_ELEM_BLOCK, 1, 12, 8, values.data());
  CHECK(values.front() == 40);
  CHECK(values.back() == 47);
  ex_close(id);

  TetMesh bad = mesh;
  bad.blocks.pop_back();
  CHECK_THROWS_WITH(validate(bad), Contains("blocks have 40 of 48"));
  bad = mesh;
  bad.side_sets[0].entries[1].tet = 48;
  CHECK_THROWS_WITH(validate(bad), Contains("side set 4 names side 4 of tet"));
  bad = mesh;
  bad.node_sets[1].entries[0] = 27;
  CHECK_THROWS_WITH(validate(bad), Contains("node set 6 names vertex 27"));
  bad = mesh;
  bad.blocks[0].id = std::int64_t{1} << 40;
  CHECK_THROWS_WITH(write_exodus(path, bad, {}),
                    Contains("block 1099511627776 'fluid' cannot be written"));
}

TEST_CASE("surface and line elements beside tetrahedra are skipped, and counted by type",
          "[m2m][io]") {
  const Scratch scratch;
  for (const char* type :
       {"TET", "TET4", "TETRA", "TETRA4", "TETRAHEDRA", "tetra", "Tetrahedron"}) {
    CAPTURE(type);
    const TetMesh mesh = read_mesh(mixed_file(scratch, type));
    CHECK(mesh.tets == std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}});
    CHECK(mesh.blocks == std::vector<Block>{{21, "", 1}, {23, "", 1}});
    CHECK(mesh.skipped == std::vector<Skipped>{{"TRI3", 2}, {"BAR2", 3}});
    CHECK(skipped_text(mesh) == "2 TRI3, 3 BAR2");
    CHECK(mesh.side_sets.at(0) == SideSet{1, "", {{0, 1}, {1, 4}}, {}});
    CHECK(mesh.side_sets.at(1) ==
          SideSet{2, "", {{1, 2}}, {}});  // the side of the triangle is left out
    CHECK(mesh.node_sets.at(0) == NodeSet{8, "", {4}, {}});
  }
  for (const auto& [type, n] :
       {std::pair{"HEX20", 20}, std::pair{"wedge", 15}, std::pair{"PYRAMID13", 13},
        std::pair{"TET4", 10}, std::pair{"HEX8", 4}, std::pair{"superelement", 4}}) {
    CAPTURE(type);
    const std::string path = mixed_file(scratch, type, n);
    CHECK_THROWS_WITH(read_mesh(path), Contains("block 21 has elements of type") &&
                                           Contains(type, Catch::CaseSensitive::No) &&
                                           Contains(path));
  }
  const TetMesh gmsh = read_gmsh("test", as_gmsh(kuhn_mesh({1}), false, false, 1));
  CHECK(gmsh.skipped == std::vector<Skipped>{{"point", 1}});
}

TEST_CASE("hexahedra, wedges and pyramids of ExodusII are split, and side sets follow",
          "[m2m][io]") {
  // A pyramid on a cube, a wedge beside it, and a tetrahedron.
  const Scratch scratch;
  const std::string path = scratch.path("solids.exo");
  const int id = tess::test::new_exodus(path);
  const std::array<double, 12> x{0, 1, 1, 0, 0, 1, 1, 0, 0.5, 2, 2, 3};
  const std::array<double, 12> y{0, 0, 1, 1, 0, 0, 1, 1, 0.5, 0, 0, 0};
  const std::array<double, 12> z{0, 0, 0, 0, 1, 1, 1, 1, 2, 0, 1, 0};
  ex_put_init(id, "solids", 3, 12, 4, 4, 0, 2);
  ex_put_coord(id, x.data(), y.data(), z.data());
  tess::test::put_block(id, 3, "HEX8", 1, {1, 2, 3, 4, 5, 6, 7, 8});
  tess::test::put_block(id, 4, "PYRAMID", 1, {5, 6, 7, 8, 9});
  tess::test::put_block(id, 5, "TETRA", 1, {10, 12, 3, 11});
  tess::test::put_block(id, 6, "wedge6", 1, {2, 10, 3, 6, 11, 7});
  const auto side_set = [&](int number, int element, int side) {
    const std::array<double, 4> factors{1, 2, 3, 4};
    ex_put_set_param(id, EX_SIDE_SET, number, 1, 4);
    ex_put_set(id, EX_SIDE_SET, number, &element, &side);
    ex_put_set_dist_fact(id, EX_SIDE_SET, number, factors.data());
  };
  side_set(1, 1, 6);
  side_set(2, 2, 5);
  ex_close(id);
  const TetMesh mesh = read_mesh(path);
  CHECK(split_text(mesh) ==
        "1 HEX8 into 6 tetrahedra, 1 PYRAMID5 into 2 tetrahedra, 1 WEDGE6 into 3 tetrahedra");
  CHECK(mesh.blocks == std::vector<Block>{{3, "", 6}, {4, "", 2}, {5, "", 1}, {6, "", 3}});
  CHECK(mesh.element_of_tet == std::vector<GlobalId>{0, 0, 0, 0, 0, 0, 1, 1, 2, 3, 3, 3});
  double volume = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    CHECK(signed_volume(mesh, t) > 0);
    volume += signed_volume(mesh, t);
  }
  CHECK(volume == Approx(1 + 1.0 / 3 + 0.5 + 1.0 / 6).epsilon(1e-14));
  // The square between cube and pyramid, from both sides: the same two triangles.
  const auto triangles = [&](const SideSet& set) {
    CHECK(set.factors.empty());
    std::vector<std::array<VertexId, 3>> found;
    for (const Side& side : set.entries) {
      constexpr std::size_t opposite[] = {2, 0, 1, 3};
      std::array<VertexId, 3> face{};
      std::size_t n = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (k != opposite[side.side - 1])
          face[n++] = mesh.tets[static_cast<std::size_t>(side.tet)][k];
      std::sort(face.begin(), face.end());
      found.push_back(face);
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  CHECK(triangles(mesh.side_sets.at(0)) ==
        std::vector<std::array<VertexId, 3>>{{4, 5, 6}, {4, 6, 7}});
  CHECK(triangles(mesh.side_sets.at(1)) == triangles(mesh.side_sets.at(0)));
  const std::string bytes = slurp(path);
  damage_everywhere("cut.exo", bytes, 100, 500, as_mesh);
}

TEST_CASE("solids of gmsh are split; a tet10 of gmsh has its last two vertices swapped",
          "[m2m][io]") {
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n";
  const TetMesh tet10 = read_gmsh(
      "tet10", head +
                   "10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .5 0 0\n6 .5 .5 0\n7 0 .5 0\n"
                   "8 0 0 .5\n9 0 .5 .5\n10 .5 0 .5\n$EndNodes\n$Elements\n1\n"
                   "1 11 2 0 0 1 2 3 4 5 6 7 8 9 10\n$EndElements\n");
  CHECK(split_text(tet10) == "1 TET10 into 8 tetrahedra");
  CHECK_THAT(
      message_of([] { (void)read_gmsh("old", "$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n"); }),
      Contains("old: is MSH 1; only 2.0 to 2.2, 4.0 and 4.1 are supported"));
  for (std::size_t t = 0; t < 8; ++t)
    CHECK(signed_volume(tet10, t) == Approx(1.0 / 48).epsilon(1e-14));
  const TetMesh solids = read_gmsh(
      "solids", head +
                    "9\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n"
                    "8 0 1 1\n9 .5 .5 2\n$EndNodes\n$Elements\n3\n1 5 2 0 0 1 2 3 4 5 6 7 8\n"
                    "2 7 2 0 0 5 6 7 8 9\n3 6 2 0 0 1 2 4 5 6 8\n$EndElements\n");
  CHECK(split_text(solids) ==
        "1 HEX8 into 6 tetrahedra, 1 PYRAMID5 into 2 tetrahedra, 1 WEDGE6 into 3 tetrahedra");
  double volume = 0;
  for (std::size_t t = 0; t < solids.n_tets(); ++t) volume += signed_volume(solids, t);
  CHECK(volume == Approx(1 + 1.0 / 3 + 0.5).epsilon(1e-14));
}

TEST_CASE("a hexahedron of 27 vertices comes in the order of ExodusII", "[m2m][io]") {
  // As gmsh writes one, in both formats.
  const std::array<std::string, 27> points{
      "0 0 0",   "1 0 0",   "0 1 0",   "1 1 0",   "0 0 1",   "1 0 1",   "1 1 1",
      "0 1 1",   ".5 0 0",  ".5 1 0",  "0 .5 0",  "1 .5 0",  ".5 0 1",  "1 .5 1",
      ".5 1 1",  "0 .5 1",  "0 0 .5",  "1 0 .5",  "1 1 .5",  "0 1 .5",  ".5 .5 0",
      ".5 0 .5", "1 .5 .5", ".5 1 .5", "0 .5 .5", ".5 .5 1", ".5 .5 .5"};
  std::string nodes, lines;
  for (std::size_t k = 0; k < 27; ++k) {
    nodes += std::to_string(k + 1) + " " + points[k] + "\n";
    lines += points[k] + "\n";
  }
  const Scratch scratch;
  const std::string vtk =
      scratch.write("hex27.vtk",
                    "# vtk DataFile Version 2.0\nhex27\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                    "POINTS 27 double\n" +
                        lines +
                        "CELLS 1 28\n27 0 1 3 2 4 5 6 7 8 11 9 10 12 13 14 15 16 17 18 19 24 22 21 "
                        "23 20 25 26\nCELL_TYPES 1\n29\n");
  const TetMesh gmsh = read_gmsh(
      "hex27", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n27\n" + nodes +
                   "$EndNodes\n$Elements\n1\n1 12 2 1 1 1 2 4 3 5 6 7 8 9 11 17 12 18 10 19 20 13 "
                   "16 14 15 21 22 25 23 24 26 27\n$EndElements\n");
  for (const TetMesh& mesh : {gmsh, read_mesh(vtk)}) {
    CHECK(split_text(mesh) == "1 HEX27 into 48 tetrahedra");
    const std::span<const VertexId> vertices = mesh.elements.vertices_at(0);
    REQUIRE(vertices.size() == 27);
    for (std::size_t k = 0; k < 27; ++k)
      CHECK(mesh.points[static_cast<std::size_t>(vertices[k])] == reference_vertex(27, k));
  }
}

TEST_CASE("a real mesh keeps its blocks and sets when it is written", "[m2m][io][.][shared_data]") {
  for (const char* name : {"nalu/3d_tet4_pipe.exo", "nalu/3d_tet4_taylor_green_0p4.exo"}) {
    const Scratch scratch;
    const TetMesh mesh = read_mesh(shared_data(name));
    CHECK(mesh.blocks.size() + mesh.side_sets.size() > 1);
    write_exodus(scratch.path("out.exo"), mesh, {});
    const TetMesh read = read_mesh(scratch.path("out.exo"));
    CHECK(read.blocks == mesh.blocks);
    CHECK(read.side_sets == mesh.side_sets);
    CHECK(read.node_sets == mesh.node_sets);
  }
}

TEST_CASE("gmsh files with missing or flipped bits give one line of error", "[m2m][io]") {
  const TetMesh mesh = kuhn_mesh({2});
  for (const bool legacy : {false, true})
    for (const bool binary : {false, true})
      damage_everywhere("cut.msh", as_gmsh(mesh, legacy, binary, 3), 200, 400, as_mesh);
}

TEST_CASE("ExodusII files with missing or flipped bits give one line of error", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = grouped_mesh();
  const std::string path = scratch.path("whole.exo");
  write_exodus(path, mesh, std::array{sample(mesh, "f", make_formula("sin", bounds(mesh)))});
  damage_everywhere("cut.exo", slurp(path), 200, 1500, as_mesh);
}

TEST_CASE(
    "an ExodusII file of another program with missing or flipped bits gives one line of error",
    "[m2m][io][.][shared_data]") {
  damage_everywhere("real.exo", slurp(shared_data("mfem/simple-cube-tet4.e")), 100, 1500, as_mesh);
}

TEST_CASE("a NetCDF-4 file is read, and a truncated one is refused", "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("four.exo");
  const int id = tess::test::new_exodus(path, EX_NETCDF4);
  const std::array<double, 4> x{0, 1, 0, 0}, y{0, 0, 1, 0}, z{0, 0, 0, 1};
  const std::array<int, 4> vertices{1, 2, 3, 4};
  ex_put_init(id, "one", 3, 4, 1, 1, 0, 0);
  ex_put_coord(id, x.data(), y.data(), z.data());
  ex_put_block(id, EX_ELEM_BLOCK, 7, "TETRA", 1, 4, 0, 0, 0);
  ex_put_conn(id, EX_ELEM_BLOCK, 7, vertices.data(), nullptr, nullptr);
  ex_close(id);
  CHECK(read_mesh(path).points.at(3)[2] == 1);
  const std::string bytes = slurp(path);
  for (const std::size_t kept :
       {std::size_t{5}, std::size_t{100}, bytes.size() / 2, bytes.size() - 1}) {
    const std::string cut = scratch.write("cut.exo", bytes.substr(0, kept));
    CHECK_THROWS_WITH(read_mesh(cut), Contains("truncated"));
  }
}
