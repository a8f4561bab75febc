#include "m2m/field_file.hpp"

#include "m2m/io/exodus/exodus_turn.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_vtu.hpp"
#include "tests/m2m/field_values.hpp"
#include "tests/m2m/io/damage.hpp"
#include "tests/m2m/io/gmsh_text.hpp"
#include "tests/m2m/io/new_exodus.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/waits_for_turn.hpp"

#include <array>
#include <exodusII.h>
#include <fmt/core.h>
#include <memory>

using namespace tess::m2m;
using tess::test::as_gmsh, tess::test::awkward_field, tess::test::bits_of, tess::test::made_mesh,
    tess::test::message_of, tess::test::read_all, tess::test::Scratch, tess::test::shared_data,
    tess::test::slurp;

namespace {

/// The mesh, with blocks, and its fields at three steps.
struct Results {
  TetMesh mesh = kuhn_mesh({2, 0.1});
  std::vector<double> times{0, 0.5, 0.75};
  std::vector<Field> temperature{}, velocity{}, part{};
};
Results write_results(const std::string& path) {
  Results results;
  results.mesh.blocks = {{7, "fluid", 40}, {12, "solid", 8}};
  const std::size_t n = results.mesh.n_points(), m = results.mesh.n_tets();
  ExodusSteps out(path, results.mesh);
  for (std::size_t step = 0; step < 3; ++step) {
    results.temperature.push_back(awkward_field("temperature", n, 1, 10 + step));
    results.velocity.push_back(awkward_field("velocity", n, 3, 20 + step));
    results.part.push_back(awkward_field("part", m, 1, 30 + step));
    out.add(results.times[step], std::array{results.temperature[step], results.velocity[step]},
            std::array{results.part[step]});
  }
  out.finish();
  return results;
}

/// A section of values. `rows`: tag and values.
struct Section {
  const char* kind = "NodeData";
  const char* name = "temp";
  double time = 0;
  int step = 0;
  std::vector<std::pair<int, std::vector<double>>> rows{};
};
std::string text_of(const Section& section, bool binary) {
  std::string out = fmt::format("${}\n1\n\"{}\"\n1\n{}\n3\n{}\n{}\n{}\n", section.kind,
                                section.name, section.time, section.step,
                                section.rows.front().second.size(), section.rows.size());
  for (const auto& [tag, values] : section.rows) {
    if (binary) {
      tess::test::put(out, tag);
      for (const double value : values) tess::test::put(out, value);
    } else {
      out += std::to_string(tag);
      for (const double value : values) out += fmt::format(" {:.17g}", value);
      out += "\n";
    }
  }
  return out + (binary ? "\n" : "") + "$End" + section.kind + "\n";
}

/// The values of a mesh of as_gmsh(mesh, …, gap), row by row from the last on.
std::vector<std::pair<int, std::vector<double>>> rows_of(const Field& field, int gap) {
  std::vector<std::pair<int, std::vector<double>>> rows;
  const std::size_t n = field.values.size() / field.n_components;
  for (std::size_t i = n; i-- > 0;) {
    const auto at = field.values.begin() + static_cast<std::ptrdiff_t>(i * field.n_components);
    rows.push_back({static_cast<int>(i) * gap + 3,
                    {at, at + static_cast<std::ptrdiff_t>(field.n_components)}});
  }
  return rows;
}

/// A hexahedron, a triangle and a tetrahedron in blocks 3, 4 and 5, with element variables `rho`
/// and `q`, the second missing in block 5.
std::string solids_with_variables(const Scratch& scratch) {
  const std::string path = scratch.path("solids.exo");
  const int id = tess::test::new_exodus(path);
  const std::array<double, 9> x{0, 1, 1, 0, 0, 1, 1, 0, 2}, y{0, 0, 1, 1, 0, 0, 1, 1, 0},
      z{0, 0, 0, 0, 1, 1, 1, 1, 0};
  ex_put_init(id, "solids", 3, 9, 3, 3, 0, 0);
  ex_put_coord(id, x.data(), y.data(), z.data());
  tess::test::put_block(id, 3, "HEX8", 1, {1, 2, 3, 4, 5, 6, 7, 8});
  tess::test::put_block(id, 4, "TRI3", 1, {1, 2, 3});
  tess::test::put_block(id, 5, "TETRA", 1, {2, 9, 3, 6});
  ex_put_variable_param(id, EX_ELEM_BLOCK, 2);
  ex_put_variable_name(id, EX_ELEM_BLOCK, 1, "rho");
  ex_put_variable_name(id, EX_ELEM_BLOCK, 2, "q");
  std::array<int, 6> has{1, 1, 1, 1, 1, 0};
  ex_put_truth_table(id, EX_ELEM_BLOCK, 3, 2, has.data());
  const double time = 4;
  ex_put_time(id, 1, &time);
  const double values[] = {30, 40, 50};
  for (int b = 0; b < 3; ++b) ex_put_var(id, 1, EX_ELEM_BLOCK, 1, 3 + b, 1, &values[b]);
  for (int b = 0; b < 2; ++b) ex_put_var(id, 1, EX_ELEM_BLOCK, 2, 3 + b, 1, &values[b]);
  ex_close(id);
  return path;
}

}  // namespace

TEST_CASE("fields of several steps are written and read back bit for bit", "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("steps.exo");
  const Results results = write_results(path);
  CHECK(scratch.n_files() == 1);
  const TetMesh mesh = read_mesh(path);
  CHECK(mesh.blocks == results.mesh.blocks);
  const FieldFile file(path);
  CHECK(file.times() == results.times);
  REQUIRE(file.fields().size() == 6);
  CHECK(file.fields()[1].name == "velocity");
  CHECK(file.fields()[1].n_components == 3);
  CHECK(file.fields()[3].name == "velocity_y");
  CHECK(file.fields()[3].is_part);
  for (const std::size_t step : {2U, 0U, 1U}) {
    CHECK(bits_of(file.vertex_field(mesh, "temperature", step).values) ==
          bits_of(results.temperature[step].values));
    const Field velocity = file.vertex_field(mesh, "velocity", step);
    CHECK(velocity.n_components == 3);
    CHECK(bits_of(velocity.values) == bits_of(results.velocity[step].values));
    CHECK(bits_of(file.vertex_field(mesh, "velocity_y", step).values)[4] ==
          bits_of(results.velocity[step].values)[13]);
    CHECK(bits_of(file.tet_field(mesh, "part", step).values) == bits_of(results.part[step].values));
  }
}

TEST_CASE("a missing field or step is refused with what the file has", "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("steps.exo");
  const Results results = write_results(path);
  const FieldFile file(path);
  const auto refusal = [&](const std::string& name, std::size_t step) {
    return message_of([&] { (void)file.vertex_field(results.mesh, name, step); });
  };
  CHECK(refusal("tmp", 0) ==
        path +
            ": has no variable 'tmp' at vertices; it has: temperature, velocity "
            "(3 components) (in elements: part); steps 0..2 (times 0 to 0.75)");
  CHECK(refusal("temperature", 3) ==
        path + ": variable 'temperature' has no step 3; the file has steps 0..2 (times 0 to 0.75)");
  CHECK_THAT(refusal("part", 0), Contains("has no variable 'part' at vertices"));
  CHECK_THROWS_WITH(file.tet_field(results.mesh, "temperature", 0),
                    Contains("has no variable 'temperature' in elements; it has: part"));
  CHECK_THROWS_WITH(file.vertex_field(kuhn_mesh({3}), "temperature", 0),
                    Contains("do not fit the mesh"));
  CHECK_THROWS_WITH(file.tet_field(kuhn_mesh({3}), "part", 0), Contains("do not fit the mesh"));
  CHECK_THROWS_WITH(FieldFile("kuhn:3"), Contains("kuhn:3: is generated"));
  CHECK_THROWS_WITH(FieldFile(scratch.path("none.exo")), Contains("none.exo: cannot be opened"));

  const std::string plain = scratch.path("plain.exo");
  ExodusSteps(plain, results.mesh).finish();
  CHECK_THROWS_WITH(
      FieldFile(plain).vertex_field(results.mesh, "u", 0),
      Contains("has no variable 'u' at vertices; it has: none") && Contains("no time steps"));
}

TEST_CASE("steps with other fields or an earlier time are refused, and no file remains",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("steps.exo");
  const TetMesh mesh = kuhn_mesh({2});
  const Field a = awkward_field("a", mesh.n_points(), 1, 1);
  const Field b = awkward_field("b", mesh.n_points(), 3, 1);
  {
    ExodusSteps out(path, mesh);
    out.add(1, std::array{a});
    CHECK_THROWS_WITH(out.add(1, std::array{a}),
                      Contains(path + ": step 1 has time 1, which is not after 1"));
    CHECK_THROWS_WITH(
        out.add(2, std::array{b}),
        Contains("step 1 has the variables b_x, b_y, b_z and none, but step 0 had a"));
  }
  CHECK(scratch.n_files() == 0);
}

TEST_CASE("two fields of one name are refused, and no file remains", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({2});
  const Field scalar = awkward_field("v_x", mesh.n_points(), 1, 1);
  const Field vector = awkward_field("v", mesh.n_points(), 3, 1);
  const Field in_tets = awkward_field("v", mesh.n_tets(), 3, 1);
  CHECK_THROWS_WITH(write_exodus(scratch.path("a.exo"), mesh, std::array{scalar, vector}),
                    Contains("a.exo: two fields have the variable 'v_x'"));
  CHECK_THROWS_WITH(write_vtu(scratch.path("a.vtu"), mesh, std::array{vector, scalar, vector}),
                    Contains("a.vtu: two fields have the name 'v'"));
  CHECK(scratch.n_files() == 0);
  CHECK_NOTHROW(write_exodus(scratch.path("a.exo"), mesh, std::array{vector}, std::array{in_tets}));
  CHECK_NOTHROW(write_vtu(scratch.path("a.vtu"), mesh, std::array{vector}, std::array{in_tets}));
}

TEST_CASE("a file of steps keeps its own copy of the path", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({2});
  const Field a = awkward_field("a", mesh.n_points(), 1, 1);
  auto path = std::make_unique<std::string>(scratch.path("steps_of_a_path_that_ends.exo"));
  const std::string copy = *path;
  ExodusSteps out(*path, mesh);
  std::fill(path->begin(), path->end(), 'x');
  path.reset();
  out.add(1, std::array{a});
  CHECK_THROWS_WITH(out.add(1, std::array{a}), Catch::StartsWith(copy + ": step 1"));
  out.finish();
  CHECK(bits_of(FieldFile(copy).vertex_field(mesh, "a", 0).values) == bits_of(a.values));
}

TEST_CASE("values of split elements are those of the whole element; skipped ones are left out",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string path = solids_with_variables(scratch);
  const TetMesh mesh = read_mesh(path);
  REQUIRE(mesh.n_tets() == 7);
  const FieldFile file(path);
  CHECK(file.times() == std::vector<double>{4});
  CHECK(file.tet_field(mesh, "rho", 0).values == std::vector<double>{30, 30, 30, 30, 30, 30, 50});
  CHECK_THROWS_WITH(file.tet_field(mesh, "q", 0),
                    Contains(path + ": variable 'q' is missing in block 5"));
}

TEST_CASE("readers and writers of ExodusII wait while another thread uses the library",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("a.exo");
  const TetMesh mesh = kuhn_mesh({2});
  const std::array fields{awkward_field("u", mesh.n_points(), 1, 3)};
  using tess::test::waits_for_turn;
  CHECK(waits_for_turn<ExodusTurn>([&] { write_exodus(path, mesh, fields); }));
  CHECK(waits_for_turn<ExodusTurn>([&] { (void)read_mesh(path); }));
  CHECK(waits_for_turn<ExodusTurn>([&] { (void)FieldFile(path); }));
  const FieldFile file(path);
  CHECK(waits_for_turn<ExodusTurn>([&] { (void)file.vertex_field(mesh, "u", 0); }));
}

TEST_CASE("scalars that are no vector stay apart", "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("scalars.exo");
  const TetMesh mesh = kuhn_mesh({1});
  std::vector<Field> fields;
  for (const char* name : {"u_x", "u_y", "w_z", "U_X", "U_Y", "U_Z", "_x", "_y", "_z", "v_x"})
    fields.push_back(awkward_field(name, mesh.n_points(), 1, 3));
  fields.push_back(awkward_field("pair", mesh.n_points(), 2, 3));
  write_exodus(path, mesh, fields);
  std::string whole;
  const FieldFile file(path);
  for (const FileField& field : file.fields())
    if (!field.is_part) whole += fmt::format("{}:{} ", field.name, field.n_components);
  CHECK(whole == "u_x:1 u_y:1 w_z:1 U:3 _x:1 _y:1 _z:1 v_x:1 pair_1:1 pair_2:1 ");
  CHECK(file.vertex_field(mesh, "U", 0).values.size() == 3 * mesh.n_points());
}

TEST_CASE("a variable without values, or of other dimensions than ExodusII defines, is refused",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("vector.exo");
  const int id = tess::test::new_exodus(path, EX_NETCDF4);
  const std::array<double, 4> x{0, 1, 0, 0}, y{0, 0, 1, 0}, z{0, 0, 0, 1};
  ex_put_init(id, "one", 3, 4, 1, 1, 0, 0);
  ex_put_coord(id, x.data(), y.data(), z.data());
  tess::test::put_block(id, 7, "TETRA", 1, {1, 2, 3, 4});
  const double time = 0;
  ex_put_time(id, 1, &time);
  // As meshio writes a scalar p and a vector u, whose dimensions have names of its own; and a name.
  int n_variables = 0, n_letters = 0, steps = 0, n_points = 0, n_components = 0;
  int names = 0, scalar = 0, vector = 0;
  const auto define = [&](const char* name, nc_type type, std::initializer_list<int> shape) {
    int variable = 0;
    REQUIRE(nc_def_var(id, name, type, static_cast<int>(shape.size()), std::data(shape),
                       &variable) == NC_NOERR);
    return variable;
  };
  REQUIRE(nc_redef(id) == NC_NOERR);
  REQUIRE(nc_inq_dimid(id, "time_step", &steps) == NC_NOERR);
  REQUIRE(nc_def_dim(id, "num_nod_var", 3, &n_variables) == NC_NOERR);
  REQUIRE(nc_def_dim(id, "letters", 33, &n_letters) == NC_NOERR);
  REQUIRE(nc_def_dim(id, "dim_nod_var00", 4, &n_points) == NC_NOERR);
  REQUIRE(nc_def_dim(id, "dim_nod_var11", 3, &n_components) == NC_NOERR);
  names = define("name_nod_var", NC_CHAR, {n_variables, n_letters});
  scalar = define("vals_nod_var1", NC_DOUBLE, {steps, n_points});
  vector = define("vals_nod_var2", NC_DOUBLE, {steps, n_points, n_components});
  REQUIRE(nc_enddef(id) == NC_NOERR);
  const std::array<std::size_t, 3> first{}, one_step{1, 4, 3};
  std::array<char, 99> letters{};
  letters[0] = 'p';
  letters[33] = 'u';
  letters[66] = 'q';
  const std::array<std::size_t, 2> all{3, 33};
  REQUIRE(nc_put_vara_text(id, names, first.data(), all.data(), letters.data()) == NC_NOERR);
  REQUIRE(nc_put_vara_double(id, scalar, first.data(), one_step.data(), x.data()) == NC_NOERR);
  const std::array<double, 12> u{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  REQUIRE(nc_put_vara_double(id, vector, first.data(), one_step.data(), u.data()) == NC_NOERR);
  ex_close(id);
  const TetMesh mesh = read_mesh(path);
  const FieldFile file(path);
  CHECK(file.vertex_field(mesh, "p", 0).values == std::vector<double>(x.begin(), x.end()));
  CHECK_THROWS_WITH(file.vertex_field(mesh, "u", 0),
                    Contains(path + ": variable vals_nod_var2 is not 4 numbers per step"));
  CHECK_THROWS_WITH(file.vertex_field(mesh, "q", 0),
                    Contains(path + ": variable 'q' has a name, but no values"));
}

TEST_CASE("gmsh's data at nodes and elements are read by name and step, in any order of tags",
          "[m2m][io]") {
  const Scratch scratch;
  TetMesh mesh = kuhn_mesh({2, 0.1});
  for (const bool legacy : {false, true}) {
    for (const bool binary : {false, true}) {
      for (const int gap : {1, 1000, 30000000}) {
        CAPTURE(legacy, binary, gap);
        const Field early = awkward_field("temp", mesh.n_points(), 1, 1);
        const Field late = awkward_field("temp", mesh.n_points(), 1, 2);
        const Field flow = awkward_field("a flow", mesh.n_points(), 3, 3);
        // Elements have the tags 1 (a point), and 2, 3, … (tetrahedra).
        Section part{"ElementData", "part", 0, 0, {{1, {-1}}}};
        for (std::size_t t = 0; t < mesh.n_tets(); ++t)
          part.rows.push_back({static_cast<int>(t + 2), {static_cast<double>(t) / 3}});
        std::string bytes = as_gmsh(mesh, legacy, binary, static_cast<std::uint64_t>(gap));
        const std::string first =
            text_of({"NodeData", "temp", 0.25, 0, rows_of(early, gap)}, binary);
        const std::string second =
            text_of({"NodeData", "temp", 1.5, 10, rows_of(late, gap)}, binary);
        bytes += text_of({"NodeData", "mask", 7, 0, rows_of(early, gap)}, binary);
        bytes += legacy ? first + second : second + first;
        bytes += text_of({"NodeData", "a flow", 0.25, 0, rows_of(flow, gap)}, binary);
        bytes += text_of({"NodeData", "other times", 10, 0, rows_of(early, gap)}, binary);
        bytes += text_of({"NodeData", "other times", 20, 10, rows_of(late, gap)}, binary);
        bytes += text_of(part, binary);
        const std::string path = scratch.write("fields.msh", bytes);
        const TetMesh read = read_mesh(path);
        CHECK(read.tets == mesh.tets);
        const FieldFile file(path);
        CHECK(file.times() == std::vector<double>{0.25, 1.5});
        const auto same = [](const Field& got, const Field& want) {
          if (got.values.size() != want.values.size()) return false;
          for (std::size_t i = 0; i < got.values.size(); ++i)  // as text, a NaN loses its bits
            if (got.values[i] != want.values[i] && got.values[i] == got.values[i]) return false;
          return true;
        };
        CHECK(same(file.vertex_field(read, "temp", 0), early));
        CHECK(same(file.vertex_field(read, "temp", 1), late));
        CHECK(same(file.vertex_field(read, "a flow", 0), flow));
        CHECK(file.tet_field(read, "part", 0).values[47] == 47.0 / 3);
        CHECK_THROWS_WITH(
            file.vertex_field(read, "other times", 1),
            Contains("has the time 20 at gmsh's step 10, where another view has 1.5"));
        CHECK_THROWS_WITH(
            file.vertex_field(read, "a flow", 1),
            Contains("variable 'a flow' has no values at step 1 (time 1.5); choose a step "
                     "at which it has some: 0"));
      }
    }
  }
}

TEST_CASE("an element that version 2.2 writes once per physical group is one element",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
      "5 1 1 1\n$EndNodes\n$Elements\n6\n";
  // The entity 1 is in the groups 10, 30 and 40, the entity 2 in 20 and 30, with partitions behind.
  const std::string path = scratch.write(
      "groups.msh",
      head +
          "1 4 2 10 1 1 2 3 4\n2 4 2 30 1 1 2 3 4\n3 4 2 40 1 1 2 3 4\n"
          "4 4 5 20 2 2 1 -2 2 3 4 5\n5 4 5 30 2 2 1 -2 2 3 4 5\n6 2 2 5 1 1 2 3\n$EndElements\n" +
          text_of({"ElementData", "c", 0, 0, {{3, {7}}, {5, {8}}}}, false));  // as gmsh writes
  const TetMesh mesh = read_mesh(path);
  CHECK(mesh.tets == std::vector<tess::m2m::Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}});
  CHECK(FieldFile(path).tet_field(mesh, "c", 0).values == std::vector<double>{7, 8});
  const std::string twice =
      scratch.write("twice.msh", head.substr(0, head.size() - 2) +
                                     "2\n1 4 2 10 1 1 2 3 4\n2 4 2 10 1 1 2 3 4\n$EndElements\n");
  CHECK(read_mesh(twice).n_tets() == 2);  // in one group: as it is
}

TEST_CASE("gmsh's partitions of a step are joined; a vertex without a value is named",
          "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  Field field = awkward_field("p", mesh.n_points(), 1, 1);
  for (double& value : field.values) value = 2;
  auto rows = rows_of(field, 1);
  const std::vector<std::pair<int, std::vector<double>>> first(rows.begin(), rows.begin() + 5),
      second(rows.begin() + 4, rows.end());
  const std::string head = as_gmsh(mesh, false, false, 1);
  const std::string whole =
      scratch.write("whole.msh", head + text_of({"NodeData", "p", 0, 0, first}, false) +
                                     text_of({"NodeData", "p", 0, 0, second}, false));
  CHECK(FieldFile(whole).vertex_field(mesh, "p", 0).values == field.values);
  const std::string part =
      scratch.write("part.msh", head + text_of({"NodeData", "p", 0, 0, first}, false));
  CHECK_THROWS_WITH(FieldFile(part).vertex_field(mesh, "p", 0),
                    Contains(part + ": variable 'p' has no value for node 3 at step 0") &&
                        Contains("3 of 8 are missing"));
  const std::string other =
      scratch.write("other.msh", head + text_of({"NodeData", "p", 0, 0, first}, false) +
                                     text_of({"NodeData", "p", 1, 1, {{3, {1, 2, 3}}}}, false));
  CHECK_THROWS_WITH(FieldFile{other}, Contains("'p' has 1 components and 3"));
}

TEST_CASE("a field with two values for a place, or one for a node that is none, is refused",
          "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  const std::string head = as_gmsh(mesh, false, false, 1);
  auto rows = rows_of(awkward_field("p", mesh.n_points(), 1, 1), 1);
  for (auto& [tag, values] : rows) values = {2};
  const auto refusal = [&](const std::string& section) {
    const std::string path = scratch.write("bad.msh", head + section);
    return message_of([&] { (void)FieldFile(path).vertex_field(mesh, "p", 0); });
  };
  const std::string once = text_of({"NodeData", "p", 0, 0, rows}, false);
  CHECK(refusal(once).empty());
  CHECK_THAT(
      refusal(once + text_of({"NodeData", "p", 0, 0, {{rows[0].first, {500}}}}, false)),
      Contains("variable 'p' has two values for node ") && Contains("2 and 500; write each once"));
  rows.emplace_back(999, std::vector<double>{2});
  CHECK_THAT(refusal(text_of({"NodeData", "p", 0, 0, rows}, false)),
             Contains("variable 'p' has a value for node 999, which the file does not have"));
  const auto file_with = [&](const std::string& arrays) {
    return scratch.write(
        "data.vtu",
        "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
        "NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>" +
            arrays +
            "</PointData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
            "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray "
            "type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray><DataArray "
            "type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray><DataArray "
            "type=\"UInt8\" Name=\"types\" "
            "format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n");
  };
  const auto array = [](const std::string& type, const std::string& values) {
    return "<DataArray type=\"" + type + "\" Name=\"f\" format=\"ascii\">" + values +
           "</DataArray>";
  };
  const auto vtu_refusal = [&](const std::string& arrays) {
    const std::string path = file_with(arrays);
    return message_of([&] { (void)FieldFile(path).vertex_field(read_mesh(path), "f", 0); });
  };
  const std::string reals = array("Float64", "1 2 3 4");
  CHECK_THAT(vtu_refusal(reals + reals), Contains("there are two variables 'f' at vertices"));
  CHECK(vtu_refusal(array("Int64", "1 2 3 -9007199254740991")).empty());
  CHECK_THAT(vtu_refusal(array("Int64", "1 2 3 9007199254740993")),
             Contains("array 'f' of type Int64 has a number from ±2^53 on"));
}

TEST_CASE("a view that gmsh saved is read", "[m2m][io][.][meshes]") {
  const std::string path = made_mesh("view");
  const TetMesh mesh = read_mesh(path);
  const Field field = FieldFile(path).vertex_field(mesh, "a constant", 0);
  CHECK(field.values == std::vector<double>(3 * mesh.n_points(), 1.5));
}

TEST_CASE("the fields of files of other programs are listed, and those that are there are read",
          "[m2m][io][.][shared_data]") {
  for (const char* name :
       {"nalu/3d_tet4_pipe.exo", "nalu/3d_tet4_taylor_green_0p4.exo", "nalu/3d_hex8_pipe.exo",
        "mfem/simple-cube-tet4.e", "mfem/indheat.bin.v41.msh", "skfem/box.msh"}) {
    CAPTURE(name);
    CHECK_NOTHROW(read_all(shared_data(name)));
  }
}

TEST_CASE("files with fields that are cut or have flipped bits give one line of error",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("steps.exo");
  (void)write_results(path);
  std::string bytes = slurp(path);
  tess::test::damage_everywhere("cut.exo", bytes, bytes.size() / 64, 1500, read_all);
  const TetMesh mesh = kuhn_mesh({1});
  for (const bool binary : {false, true}) {
    bytes = as_gmsh(mesh, !binary, binary, 2);
    for (int step = 0; step < 3; ++step)
      bytes += text_of({"NodeData", "temp", 1.0 * step, step,
                        rows_of(awkward_field("temp", mesh.n_points(), 2, 5), 2)},
                       binary);
    const std::size_t n_mesh = as_gmsh(mesh, !binary, binary, 2).size();
    // A cut between sections leaves a sound file of fewer steps.
    tess::test::damage_everywhere("cut.msh", bytes, 1, 1000, read_all);
    for (std::size_t kept = n_mesh; kept < bytes.size(); ++kept)
      tess::test::check_refusal(scratch.write("cut.msh", bytes.substr(0, kept)), read_all);
    CHECK_THAT(
        message_of([&] { read_all(scratch.write("cut.msh", bytes.substr(0, bytes.size() - 30))); }),
        Contains("truncated"));
  }
}
