// Meshes that lie in several files, as parallel programs write them.
#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_vtu.hpp"
#include "tests/m2m/field_values.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <array>

using namespace tess::m2m;
using tess::test::awkward_field, tess::test::bits_of, tess::test::message_of, tess::test::Scratch;

TEST_CASE("a .pvtu is read with its fields: the files that it names, in their order", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh one = kuhn_mesh({2, 0.1}), other = kuhn_mesh({1});
  const auto write = [&](const char* name, const TetMesh& mesh, std::uint64_t seed) {
    write_vtu(scratch.path(name), mesh, std::array{awkward_field("u", mesh.n_points(), 3, seed)},
              std::array{awkward_field("rho", mesh.n_tets(), 1, seed)}, 0.5);
  };
  write("b.0.vtu", one, 1);
  write("b.1.vtu", other, 2);
  const std::string index =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\">\n<PUnstructuredGrid>\n"
      "<PPoints><PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints>\n"
      "<Piece Source=\"b.1.vtu\"/>\n<Piece "
      "Source=\"b.0.vtu\"/>\n</PUnstructuredGrid>\n</VTKFile>\n";
  const std::string path = scratch.write("b.pvtu", index);
  const TetMesh mesh = read_mesh(path);
  CHECK(mesh.name == path);
  REQUIRE(mesh.n_points() == other.n_points() + one.n_points());
  REQUIRE(mesh.n_tets() == other.n_tets() + one.n_tets());
  CHECK(mesh.points[other.n_points() + 5] == one.points[5]);
  CHECK(mesh.tets[0] == other.tets[0]);
  CHECK(mesh.tets[other.n_tets()][0] == one.tets[0][0] + static_cast<VertexId>(other.n_points()));
  const FieldFile file(path);
  CHECK(file.times() == std::vector<double>{0.5});
  const auto same = [](const Field& joint, const Field& first, const Field& second) {
    std::vector<double> values = first.values;
    values.insert(values.end(), second.values.begin(), second.values.end());
    return bits_of(joint.values) == bits_of(values);
  };
  CHECK(same(file.vertex_field(mesh, "u", 0), awkward_field("u", other.n_points(), 3, 2),
             awkward_field("u", one.n_points(), 3, 1)));
  CHECK(same(file.tet_field(mesh, "rho", 0), awkward_field("rho", other.n_tets(), 1, 2),
             awkward_field("rho", one.n_tets(), 1, 1)));
  const auto refused = [&](const std::string& text) {
    const std::string bad = scratch.write("bad.pvtu", text);
    return message_of([&] { (void)read_mesh(bad); });
  };
  CHECK_THAT(refused(std::string(index).replace(index.find("b.1"), 3, "b.2")),
             Contains("b.2.vtu: cannot be opened"));
  CHECK_THAT(refused(std::string(index).replace(index.find("b.1.vtu"), 7, "b.pvtu")),
             Contains("b.pvtu: holds a VTK PUnstructuredGrid; only UnstructuredGrid"));
  CHECK_THAT(refused(index.substr(0, index.size() - 5)), Contains("</VTKFile> is missing"));
  CHECK_THAT(refused("<VTKFile type=\"PUnstructuredGrid\"></VTKFile>"),
             Contains("it names no Piece"));
}
