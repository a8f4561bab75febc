// Legacy .vtk files, as VTK writes them.
#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "tests/m2m/field_values.hpp"
#include "tests/m2m/io/damage.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <array>
#include <fmt/core.h>

using namespace tess::m2m;
using tess::test::bits_of, tess::test::message_of, tess::test::Scratch;

namespace {

std::string legacy_file(const TetMesh& mesh, const Field& u, const Field& q, bool binary,
                        bool is_5) {
  std::string out =
      fmt::format("# vtk DataFile Version {}\na title\n{}\nDATASET UNSTRUCTURED_GRID\n",
                  is_5 ? "5.1" : "3.0", binary ? "BINARY" : "ASCII");
  const auto put = [&]<class T>(T value) {
    if (!binary) {
      out += fmt::format("{} ", value);
      return;
    }
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
    std::ranges::reverse(bytes);
    out += bytes;
  };
  const std::size_t n = mesh.n_tets(), n_each = static_cast<std::size_t>(mesh.dimension) + 1;
  out += "FIELD FieldData 1\nTIME 1 1 double\n";
  put(0.25);
  out += fmt::format("\nMETADATA\nINFORMATION 0\n\nPOINTS {} double\n", mesh.n_points());
  for (const Point& p : mesh.points)
    for (const double x : p) put(x);
  out += fmt::format("\nCELLS {} {}\n", is_5 ? n + 1 : n, is_5 ? n * n_each : n * (n_each + 1));
  if (is_5) {
    out += "OFFSETS vtktypeint64\n";
    for (std::size_t t = 0; t <= n; ++t) put(static_cast<std::int64_t>(n_each * t));
    out += "\nCONNECTIVITY vtktypeint64\n";
  }
  for (const Tet& tet : mesh.tets) {
    if (!is_5) put(static_cast<std::int32_t>(n_each));
    for (std::size_t k = 0; k < n_each; ++k)
      is_5 ? put(std::int64_t{tet[k]}) : put(std::int32_t{tet[k]});
  }
  out += fmt::format("\nCELL_TYPES {}\n", n);
  for (std::size_t t = 0; t < n; ++t) put(mesh.dimension == 3 ? 10 : 5);
  out += fmt::format("\nCELL_DATA {}\nSCALARS the%20q double 1\nLOOKUP_TABLE default\n", n);
  for (const double x : q.values) put(x);
  out += fmt::format("\nPOINT_DATA {}\nVECTORS u double\n", mesh.n_points());
  for (const double x : u.values) put(x);
  out += fmt::format("\nFIELD more 1\nid 1 {} int\n", mesh.n_points());
  for (std::size_t v = 0; v < mesh.n_points(); ++v) put(static_cast<std::int32_t>(v));
  return out + "\n";
}

Field counted(const char* name, std::size_t n_rows, std::size_t n_components) {
  Field out{name, n_components, {}};
  for (std::size_t i = 0; i < n_rows * n_components; ++i)
    out.values.push_back(1.0 / static_cast<double>(i + 1));
  return out;
}

}  // namespace

TEST_CASE("legacy VTK files of text and binary are read, and their damage is refused",
          "[m2m][io]") {
  const Scratch scratch;
  TetMesh surface;
  surface.dimension = 2;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}, {1, 1, 0.1}};
  surface.tets = {{0, 1, 2, 2}, {1, 3, 2, 2}};
  for (const TetMesh& mesh : {kuhn_mesh({2, 0.2}), surface}) {
    const Field u = counted("u", mesh.n_points(), 3), q = counted("q", mesh.n_tets(), 1);
    for (const bool binary : {false, true})
      for (const bool is_5 : {false, true}) {
        CAPTURE(binary, is_5);
        const std::string bytes = legacy_file(mesh, u, q, binary, is_5);
        const std::string path = scratch.write("a.vtk", bytes);
        const TetMesh read = read_mesh(path);
        CHECK(read.dimension == mesh.dimension);
        CHECK(read.points == mesh.points);
        CHECK(read.tets == mesh.tets);
        const FieldFile file(path);
        CHECK(file.times() == std::vector{0.25});
        CHECK(bits_of(file.vertex_field(read, "u", 0).values) == bits_of(u.values));
        CHECK(bits_of(file.tet_field(read, "the q", 0).values) == bits_of(q.values));
        CHECK(file.vertex_field(read, "id", 0).values[3] == 3);
        const std::size_t mesh_end = bytes.find("CELL_DATA");
        tess::test::damage_everywhere("cut.vtk", bytes.substr(0, mesh_end - 2), 60, 0,
                                      tess::test::read_all);
        tess::test::damage_everywhere("flip.vtk", bytes, 0, 400, tess::test::read_all);
      }
  }
}

TEST_CASE("what a legacy VTK file can hold and is not supported is refused by name", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  const std::string good = legacy_file(mesh, counted("u", 8, 3), counted("q", 6, 1), false, false);
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string bad = good;
    bad.replace(bad.find(from), from.size(), to);
    const std::string path = scratch.write("bad.vtk", bad);
    const std::string message = message_of([&] { tess::test::read_all(path); });
    CHECK_THAT(message, Catch::StartsWith(path + ": "));
    CHECK(message.find('\n') == std::string::npos);
    return message;
  };
  CHECK_THAT(refusal("UNSTRUCTURED_GRID", "POLYDATA"),
             Contains("holds a VTK dataset 'polydata'; only unstructured_grid"));
  CHECK_THAT(refusal("ASCII", "TEXT"), Contains("neither ASCII nor BINARY"));
  CHECK_THAT(refusal("q double", "q bit"), Contains("array 'the q' is of type bit"));
  CHECK_THAT(refusal("CELL_TYPES 6", "CELL_TYPES 5"), Contains("truncated or damaged"));
  CHECK_THAT(refusal("CELLS 6 30", "CELLS 7 30"), Contains("7 cells announced, 6 found"));
  CHECK_THAT(refusal("POINTS 8", "POINTS 800"), Contains("truncated or damaged"));
  CHECK_THAT(refusal("\n4 ", "\n9 "), Contains("truncated or damaged"));
  CHECK_THAT(refusal("id 1 8", "id 1 7"), Contains("'id' has 7 rows of 8"));
  CHECK_THAT(refusal("VECTORS", "ARROWS"), Contains("'arrows' is no attribute"));
}

TEST_CASE("a legacy VTK file of another program is read", "[m2m][io][.][shared_data]") {
  const std::string path = tess::test::shared_data("skfem/troublesome_mesh.vtk");
  const TetMesh mesh = read_mesh(path);
  CHECK(mesh.dimension == 2);
  CHECK(mesh.n_tets() > 100);
}
