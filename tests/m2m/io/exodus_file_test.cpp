// ExodusII files whose parts contradict each other: libexodusII does not notice it.
#include "m2m/field_file.hpp"
#include "m2m/io/ranges/mesh_ranges.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "tests/m2m/io/new_exodus.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <array>
#include <exodusII.h>
#include <fmt/core.h>
#include <functional>
#include <netcdf.h>
#include <vector>

using namespace tess::m2m;
using tess::test::message_of, tess::test::Scratch, tess::test::slurp;

namespace {

/// Two tetrahedra in two blocks, a side set and a node set of one entry each, and a time step.
/// `change` gets the open file, in NetCDF's define mode.
std::string two_tets(const Scratch& scratch, int mode, const std::function<void(int id)>& change) {
  const std::string path = scratch.path("two.exo");
  const int id = tess::test::new_exodus(path, mode);
  const std::array<double, 5> x{0, 1, 0, 0, 1}, y{0, 0, 1, 0, 1}, z{0, 0, 0, 1, 1};
  ex_put_init(id, "two", 3, 5, 2, 2, 1, 1);
  ex_put_coord(id, x.data(), y.data(), z.data());
  tess::test::put_block(id, 1, "TET4", 1, {1, 2, 3, 4});
  tess::test::put_block(id, 2, "TET4", 1, {2, 3, 4, 5});
  const int one = 1;
  const std::array<double, 3> factors{1, 2, 3};
  ex_put_set_param(id, EX_SIDE_SET, 7, 1, 3);
  ex_put_set(id, EX_SIDE_SET, 7, &one, &one);
  ex_put_set_dist_fact(id, EX_SIDE_SET, 7, factors.data());
  ex_put_set_param(id, EX_NODE_SET, 8, 1, 1);
  ex_put_set(id, EX_NODE_SET, 8, &one, nullptr);
  ex_put_set_dist_fact(id, EX_NODE_SET, 8, factors.data());
  const double time = 0;
  ex_put_time(id, 1, &time);
  REQUIRE(nc_redef(id) == NC_NOERR);
  change(id);
  (void)nc_enddef(id);
  ex_close(id);
  return path;
}

/// A copy in which the k-th variable is the first; none if there are fewer.
std::string with_first(const Scratch& scratch, const std::string& path, int k) {
  const std::string name = scratch.path("first.exo");
  int from = 0, to = 0, n_dimensions = 0, n_variables = 0, n_attributes = 0, records = 0;
  REQUIRE(nc_open(path.c_str(), NC_NOWRITE, &from) == NC_NOERR);
  REQUIRE(nc_inq(from, &n_dimensions, &n_variables, &n_attributes, &records) == NC_NOERR);
  REQUIRE(nc_create(name.c_str(), NC_64BIT_OFFSET, &to) == NC_NOERR);
  std::array<char, NC_MAX_NAME + 1> text{};
  for (int i = 0; i < n_dimensions; ++i) {
    std::size_t length = 0;
    int same = 0;
    REQUIRE(nc_inq_dim(from, i, text.data(), &length) == NC_NOERR);
    REQUIRE(nc_def_dim(to, text.data(), i == records ? NC_UNLIMITED : length, &same) == NC_NOERR);
  }
  for (int i = 0; i < n_attributes; ++i) {
    REQUIRE(nc_inq_attname(from, NC_GLOBAL, i, text.data()) == NC_NOERR);
    REQUIRE(nc_copy_att(from, NC_GLOBAL, text.data(), to, NC_GLOBAL) == NC_NOERR);
  }
  REQUIRE(nc_enddef(to) == NC_NOERR);
  for (int i = 0; i < n_variables; ++i)
    REQUIRE(nc_copy_var(from, (i + k) % n_variables, to) == NC_NOERR);
  nc_close(from);
  REQUIRE(nc_close(to) == NC_NOERR);
  return k < n_variables ? name : "";
}

std::string refusal_of_file(const std::string& path) {
  const std::string message = message_of([&] {
    (void)read_mesh(path);
    (void)FieldFile(path);
  });
  CHECK(message.find('\n') == std::string::npos);
  return message;
}

}  // namespace

TEST_CASE("a list of an ExodusII file that is longer than its count is refused", "[m2m][io]") {
  const Scratch scratch;
  for (const int mode : {0, EX_NETCDF4}) {
    CHECK(refusal_of_file(two_tets(scratch, mode, [](int) {})).empty());
    for (const char* list :
         {"eb_prop1", "eb_status", "ss_prop1", "ss_status", "ns_prop1", "ns_status", "elem_ss1",
          "side_ss1", "dist_fact_ss1", "node_ns1", "dist_fact_ns1", "time_whole"}) {
      CAPTURE(mode, list);
      const std::string path = two_tets(scratch, mode, [&](int id) {
        int variable = 0, longer = 0;
        nc_type type = NC_INT;
        REQUIRE(nc_inq_varid(id, list, &variable) == NC_NOERR);
        REQUIRE(nc_inq_vartype(id, variable, &type) == NC_NOERR);
        REQUIRE(nc_rename_var(id, variable, "elsewhere") == NC_NOERR);
        REQUIRE(nc_def_dim(id, "longer", 300'000, &longer) == NC_NOERR);
        REQUIRE(nc_def_var(id, list, type, 1, &longer, &variable) == NC_NOERR);
        REQUIRE(nc_enddef(id) == NC_NOERR);
        const std::vector<int> ones(300'000, 1);
        REQUIRE(nc_put_var_int(id, variable, ones.data()) == NC_NOERR);
      });
      CHECK_THAT(refusal_of_file(path), Contains(std::string("variable ") + list + " has "));
    }
  }
}

TEST_CASE("a type of elements of more than 32 characters is refused", "[m2m][io]") {
  const Scratch scratch;
  for (const int mode : {0, EX_NETCDF4}) {
    for (const std::size_t length : {32U, 33U, 34U, 100U, 4000U}) {
      CAPTURE(mode, length);
      const std::string path = two_tets(scratch, mode, [&](int id) {
        int variable = 0;
        REQUIRE(nc_inq_varid(id, "connect1", &variable) == NC_NOERR);
        std::string type = "TET4";
        type.resize(length);
        REQUIRE(nc_put_att_text(id, variable, "elem_type", length, type.data()) == NC_NOERR);
      });
      const std::string message = refusal_of_file(path);
      CHECK(message.empty() == (length <= 33));  // with the null byte
      if (length > 33) CHECK_THAT(message, Contains("elem_type"));
    }
  }
}

TEST_CASE("an ExodusII file in NetCDF-3 has no more nodes than bytes", "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("claims.exo");
  int dimension = 0;
  const int id = tess::test::new_exodus(path);
  (void)nc_redef(id);
  for (const auto& [name, length] :
       {std::pair{"num_dim", 3U}, {"num_nodes", 100'000U}, {"num_elem", 1U}, {"num_el_blk", 1U}})
    REQUIRE(nc_def_dim(id, name, length, &dimension) == NC_NOERR);
  (void)nc_enddef(id);
  ex_close(id);
  CHECK_THAT(refusal_of_file(path), Contains("number of nodes"));
}

TEST_CASE("an ExodusII file that was not closed, or has two dimensions of a name, is refused",
          "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  write_exodus(scratch.path("a.exo"), mesh,
               std::array{Field{"f", 1, std::vector<double>(mesh.n_points())}});
  const std::string bytes = slurp(scratch.path("a.exo"));
  const std::size_t n = bytes[3] == 5 ? 8 : 4;
  std::string open = bytes;
  open.replace(4, n, n, '\xff');
  CHECK_THAT(refusal_of_file(scratch.write("open.exo", open)),
             Contains("the number of records is unknown, since the file was not closed"));
  std::string twice = bytes;
  twice.replace(twice.find("len_string"), 10, "num_el_blk");
  CHECK_THAT(refusal_of_file(scratch.write("twice.exo", twice)),
             Contains("two dimensions are called num_el_blk"));
}

TEST_CASE("polygons and springs of ExodusII are skipped, and solids in one list are refused",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("polygons.exo");
  const int id = tess::test::new_exodus(path);
  const std::array<double, 5> x{0, 1, 0, 0, 1}, y{0, 0, 1, 0, 1}, z{0, 0, 0, 1, 1};
  ex_put_init(id, "polygons", 3, 5, 3, 3, 0, 0);
  ex_put_coord(id, x.data(), y.data(), z.data());
  const int n_corners = 4;
  tess::test::put_block(id, 1, "TET4", 1, {1, 2, 3, 4});
  tess::test::put_block(id, 2, "nsided", 1, {1, 2, 3, 4});  // its size is the sum of corners
  ex_put_entity_count_per_polyhedra(id, EX_ELEM_BLOCK, 2, &n_corners);
  tess::test::put_block(id, 3, "SPRING", 1, {1, 2});
  ex_close(id);
  const TetMesh mesh = read_mesh(path);
  CHECK(mesh.n_tets() == 1);
  CHECK(skipped_text(mesh) == "1 NSIDED, 1 SPRING");
  std::string bytes = slurp(path);
  const std::size_t at = bytes.find("nsided");
  REQUIRE(at != std::string::npos);
  bytes.replace(at, 6, "TETRA4");
  CHECK_THAT(refusal_of_file(scratch.write("solid.exo", bytes)),
             Contains("variable connect2 has "));
  const std::string in_netcdf4 = two_tets(scratch, EX_NETCDF4, [](int file) {
    int variable = 0, vertices = 0;
    REQUIRE(nc_inq_varid(file, "connect2", &variable) == NC_NOERR);
    REQUIRE(nc_rename_var(file, variable, "elsewhere") == NC_NOERR);
    REQUIRE(nc_inq_dimid(file, "num_nod_per_el2", &vertices) == NC_NOERR);
    REQUIRE(nc_def_var(file, "connect2", NC_INT, 1, &vertices, &variable) == NC_NOERR);
    REQUIRE(nc_put_att_text(file, variable, "elem_type", 4, "TET4") == NC_NOERR);
  });
  CHECK_THAT(refusal_of_file(in_netcdf4), Contains("variable connect2 has "));
}

TEST_CASE("edges, faces and sets of elements of an ExodusII file are skipped by name",
          "[m2m][io]") {
  const Scratch scratch;
  const std::string path = two_tets(scratch, 0, [](int file) {
    int dimension = 0, n = 0;
    for (const char* name :
         {"num_ed_blk", "num_fa_blk", "num_edge_sets", "num_face_sets", "num_elem_sets"})
      REQUIRE(nc_def_dim(file, name, static_cast<std::size_t>(++n), &dimension) == NC_NOERR);
  });
  CHECK(skipped_text(read_mesh(path)) ==
        "1 edge block, 2 face block, 3 edge set, 4 face set, 5 element set");
  CHECK(open_ranges(path) == nullptr);  // read_mesh() names them
  CHECK(open_ranges(two_tets(scratch, 0, [](int) {})) != nullptr);
}

TEST_CASE(
    "whichever variable of an ExodusII file is the first, the mesh and its fields are the same",
    "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({2, 0.1});
  const Field u{"u", 1, std::vector<double>(mesh.n_points(), 3)};
  const Field rho{"rho", 1, std::vector<double>(mesh.n_tets(), 4)};
  const std::string path = scratch.path("whole.exo");
  write_exodus(path, mesh, std::array{u}, std::array{rho});
  int k = 0;
  for (std::string copy = with_first(scratch, path, 0); !copy.empty();
       copy = with_first(scratch, path, ++k)) {
    CAPTURE(k);
    const TetMesh read = read_mesh(copy);
    CHECK(read.points == mesh.points);
    CHECK(read.tets == mesh.tets);
    const FieldFile fields(copy);
    CHECK(fields.vertex_field(read, "u", 0).values == u.values);
    CHECK(fields.tet_field(read, "rho", 0).values == rho.values);
    const auto ranges = open_ranges(copy);
    REQUIRE(ranges != nullptr);
    std::vector<Point> points(mesh.n_points());
    ranges->points(0, points);
    CHECK(points == mesh.points);
  }
  CHECK(k > 8);  // also the coordinates, which the library takes for missing then
}

TEST_CASE("names of an ExodusII file are as long as it has them, and two of a name are refused",
          "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  const std::string stem(60, 'n');
  const auto field = [&](const std::string& name, double value) {
    return Field{name, 1, std::vector<double>(mesh.n_points(), value)};
  };
  const std::string path = scratch.path("long.exo");
  write_exodus(path, mesh, std::array{field(stem + "1", 1), field(stem + "2", 2)});
  std::string bytes = slurp(path);
  const std::string attribute = "maximum_name_length";
  bytes.replace(bytes.find(attribute), attribute.size(), std::string("m").append(18, 'x'));
  const FieldFile file(scratch.write("without.exo", bytes));
  CHECK(file.vertex_field(mesh, stem + "1", 0).values[0] == 1);
  CHECK(file.vertex_field(mesh, stem + "2", 0).values[0] == 2);
  bytes.replace(bytes.find(stem + "2"), 61, stem + "1");
  const FieldFile twice(scratch.write("twice.exo", bytes));
  CHECK_THROWS_WITH(twice.vertex_field(mesh, stem + "1", 0),
                    Contains("there are two variables '" + stem + "1' at vertices"));
}

TEST_CASE("components that have their letter at the end or in front are one vector", "[m2m][io]") {
  const Scratch scratch;
  const std::string path = scratch.path("vectors.exo");
  const TetMesh mesh = kuhn_mesh({1});
  std::vector<Field> fields;
  double value = 0;
  for (const char* name : {"velocityx", "velocityy", "velocityz", "xforce", "yforce", "zforce",
                           "X_B", "Y_B", "Z_B", "x", "y", "z", "c", "cx", "cy", "cz"})
    fields.push_back({name, 1, std::vector<double>(mesh.n_points(), ++value)});
  write_exodus(path, mesh, fields);
  const FieldFile file(path);
  std::string whole;
  for (const FileField& field : file.fields())
    if (!field.is_part) whole += fmt::format("{}:{} ", field.name, field.n_components);
  CHECK(whole == "velocity:3 force:3 B:3 x:1 y:1 z:1 c:1 cx:1 cy:1 cz:1 ");  // c is a scalar
  const std::vector<double> force = file.vertex_field(mesh, "force", 0).values;
  CHECK(std::vector<double>(force.begin(), force.begin() + 3) == std::vector<double>{4, 5, 6});
  CHECK(file.vertex_field(mesh, "yforce", 0).values[0] == 5);
}
