#include "m2m/write_vtu.hpp"

#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/core/escape.hpp"
#include "tests/m2m/field_values.hpp"
#include "tests/m2m/io/damage.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/core.h>
#include <zlib.h>

using namespace tess::m2m;
using tess::test::awkward_field, tess::test::bits_of, tess::test::message_of, tess::test::read_all,
    tess::test::Scratch, tess::test::slurp;

namespace {

std::string base64(const std::string& bytes) {
  constexpr const char* alphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(i + k > bytes.size() ? '=' : alphabet[bits >> (18 - 6 * k) & 63U]);
  }
  return out;
}

/// A way to write arrays.
struct Style {
  const char* name;
  const char* format = "ascii";  // of DataArray
  bool is_base64 = true, zlib = false, wide = false, big_endian = false;
  std::size_t block_bytes = 100;  // of zlib
};

/// Collects arrays and writes a file in a style.
class Vtu {
 public:
  explicit Vtu(Style style) : style_(style) {}

  template <class T>
  std::string array(const char* type, const char* name, std::size_t n_components,
                    const std::vector<T>& numbers) {
    std::string head =
        fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="{}")", type,
                    name, n_components, style_.format);
    if (std::string(style_.format) == "ascii") {
      head += ">\n";
      for (const T number : numbers) head += fmt::format("{} ", number);
      return head + "\n</DataArray>\n";
    }
    std::string bytes;
    for (const T number : numbers) bytes += swapped(number);
    if (std::string(style_.format) == "binary")
      return head + ">\n  " + packed(bytes) + "\n</DataArray>\n";
    head += fmt::format(" offset=\"{}\"/>\n", appended_.size());
    appended_ += packed(bytes);
    return head;
  }
  std::string file(const std::string& inside) {
    std::string out = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- a > comment -->\n<VTKFile type=\"UnstructuredGrid\" "
        "version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{}>\n<UnstructuredGrid>\n{}"
        "</UnstructuredGrid>\n",
        style_.big_endian ? "BigEndian" : "LittleEndian", style_.wide ? "UInt64" : "UInt32",
        style_.zlib ? " compressor=\"vtkZLibDataCompressor\"" : "", inside);
    if (!appended_.empty())
      out += fmt::format("<AppendedData encoding=\"{}\">\n _{}\n</AppendedData>\n",
                         style_.is_base64 ? "base64" : "raw", appended_);
    return out + "</VTKFile>\n";
  }

 private:
  template <class T>
  std::string swapped(T number) const {
    std::string bytes(reinterpret_cast<const char*>(&number), sizeof(T));
    if (style_.big_endian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }
  std::string header(std::uint64_t n) const {
    return style_.wide ? swapped(n) : swapped(static_cast<std::uint32_t>(n));
  }
  /// In blocks, if compressed.
  std::string packed(const std::string& bytes) const {
    const auto text = [&](const std::string& some) {
      return style_.is_base64 ? base64(some) : some;
    };
    if (!style_.zlib) return text(header(bytes.size()) + bytes);
    std::string head, data;
    const std::size_t each = style_.block_bytes, n_blocks = (bytes.size() + each - 1) / each;
    head = header(n_blocks) + header(each) + header(bytes.size() % each);
    for (std::size_t at = 0; at < bytes.size(); at += each) {
      const std::string block = bytes.substr(at, each);
      std::string out(compressBound(block.size()), '\0');
      uLongf n = out.size();
      REQUIRE(compress(reinterpret_cast<Bytef*>(out.data()), &n,
                       reinterpret_cast<const Bytef*>(block.data()), block.size()) == Z_OK);
      head += header(n);
      data += out.substr(0, n);
    }
    return text(head) + text(data);
  }

  Style style_;
  std::string appended_;
};

std::vector<double> flat(const std::vector<Point>& points) {
  std::vector<double> out;
  for (const Point& p : points) out.insert(out.end(), p.begin(), p.end());
  return out;
}

/// A piece of any cells.
struct Cells {
  std::vector<Point> points;
  std::vector<std::pair<int, std::vector<std::int64_t>>> cells;
  Field at_points{}, in_cells{};
};
std::string piece_of(Vtu& vtu, const Cells& c) {
  std::vector<std::int64_t> vertices, ends;
  std::vector<std::int32_t> types;
  for (const auto& [type, ids] : c.cells) {
    vertices.insert(vertices.end(), ids.begin(), ids.end());
    ends.push_back(static_cast<std::int64_t>(vertices.size()));
    types.push_back(type);
  }
  const auto field = [&](const Field& f) {
    return f.name.empty() ? std::string()
                          : vtu.array("Float64", f.name.c_str(), f.n_components, f.values);
  };
  return fmt::format(
             "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>{}</PointData>"
             "<CellData>{}</CellData>",
             c.points.size(), c.cells.size(), field(c.at_points), field(c.in_cells)) +
         "<Points>" + vtu.array("Float64", "Points", 3, flat(c.points)) + "</Points><Cells>" +
         vtu.array("Int64", "connectivity", 1, vertices) + vtu.array("Int64", "offsets", 1, ends) +
         vtu.array("Int32", "types", 1, types) + "</Cells></Piece>\n";
}
std::string vtu_of(const Cells& cells, const Style& style = {"ascii"}) {
  Vtu vtu(style);
  const std::string piece = piece_of(vtu, cells);
  return vtu.file(piece);
}

Cells cells_of(const TetMesh& mesh) {
  Cells out{mesh.points, {}};
  for (const Tet& tet : mesh.tets) out.cells.push_back({10, {tet.begin(), tet.end()}});
  return out;
}

constexpr std::array styles{
    Style{"ascii"},
    Style{"binary", "binary"},
    Style{"binary, wide", "binary", true, false, true},
    Style{"binary, zlib", "binary", true, true},
    Style{"binary, zlib, wide", "binary", true, true, true},
    Style{"raw", "appended", false},
    Style{"raw, zlib", "appended", false, true, true},
    Style{"appended base64", "appended"},
    Style{"appended base64, zlib", "appended", true, true},
    Style{"raw, big-endian", "appended", false, false, true, true},
    Style{"zlib, big-endian", "binary", true, true, false, true},
    Style{"zlib, part of a block", "binary", true, true, false, false, 32768}};

}  // namespace

TEST_CASE("a mesh with fields is written as VTU and read back bit for bit", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  const std::array at_vertices{awkward_field("p", mesh.n_points(), 1, 1),
                               awkward_field("a <\"name\"> & more", mesh.n_points(), 3, 2),
                               awkward_field("six", mesh.n_points(), 6, 3)};
  const std::array in_tets{awkward_field("p", mesh.n_tets(), 1, 4)};
  const std::string path = scratch.path("out.vtu");
  write_vtu(path, mesh, at_vertices, in_tets, 0.125);
  write_vtu(path, mesh, at_vertices, in_tets, 0.125);  // overwrites it
  CHECK(scratch.n_files() == 1);
  const TetMesh read = read_mesh(path);
  CHECK(read.points == mesh.points);
  CHECK(read.tets == mesh.tets);
  const FieldFile file(path);
  CHECK(file.times() == std::vector<double>{0.125});
  for (const Field& field : at_vertices) {
    const Field got = file.vertex_field(read, field.name, 0);
    CHECK(got.n_components == field.n_components);
    CHECK(bits_of(got.values) == bits_of(field.values));
  }
  CHECK(bits_of(file.tet_field(read, "p", 0).values) == bits_of(in_tets[0].values));
  CHECK_THROWS_WITH(write_vtu(scratch.path("no/folder.vtu"), mesh, {}),
                    Contains("no/folder.vtu: cannot be written"));
}

TEST_CASE("every encoding of VTU gives the same mesh and fields", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({2, 0.1});
  Cells cells = cells_of(mesh);
  cells.at_points = awkward_field("u", mesh.n_points(), 3, 1);
  cells.in_cells = awkward_field("rho", mesh.n_tets(), 1, 2);
  for (Field* field : {&cells.at_points, &cells.in_cells})
    for (double& value : field->values)
      if (value != value) value = 7;  // text loses the bits of a NaN
  for (const Style& style : styles) {
    CAPTURE(style.name);
    const std::string path = scratch.write("mesh.vtu", vtu_of(cells, style));
    const TetMesh read = read_mesh(path);
    CHECK(read.points == mesh.points);
    CHECK(read.tets == mesh.tets);
    const FieldFile file(path);
    CHECK(bits_of(file.vertex_field(read, "u", 0).values) == bits_of(cells.at_points.values));
    CHECK(bits_of(file.tet_field(read, "rho", 0).values) == bits_of(cells.in_cells.values));
  }
}

TEST_CASE("names in VTU may have numbers of characters", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  Cells cells = cells_of(mesh);
  cells.at_points = awkward_field("NAME", mesh.n_points(), 1, 1);
  const std::string text = vtu_of(cells);
  const std::size_t at = text.find("NAME");
  for (const auto& [written, name] : {std::pair("it&#39;s", "it's"),
                                      {"&#xE9;&#x20AC;&#128512;", "\u00e9\u20ac\U0001f600"},
                                      {"&#;&#x;&#0;&#1114112;&#39", "&#;&#x;&#0;&#1114112;&#39"}}) {
    const std::string path = scratch.write("named.vtu", std::string(text).replace(at, 4, written));
    CHECK(FieldFile(path).vertex_field(mesh, name, 0).values.size() == mesh.n_points());
  }
}

TEST_CASE("names of fields with any bytes give VTU that is read", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  const auto named = [&](const std::string& name, double value) {
    return Field{name, 1, std::vector<double>(mesh.n_points(), value)};
  };
  const std::string blanks = "\t\r\n", held = "it's <a> & \"b\" \u00e9\u2192";
  const std::string path = scratch.path("named.vtu");
  write_vtu(path, mesh, std::array{named(held + blanks, 1), named("caf\xe9 \x01", 2)});
  const FieldFile file(path);
  CHECK(file.vertex_field(mesh, held + "???", 0).values[0] == 1);  // control characters
  CHECK(file.vertex_field(mesh, "caf\ufffd \ufffd", 0).values[0] == 2);
  const std::string head = slurp(path).substr(0, slurp(path).find("<AppendedData"));
  CHECK(tess::xml_characters(head) == head);
  CHECK_THAT(head, Contains(tess::xml_text(held) + "&#9;&#13;&#10;\""));
  CHECK_THROWS_WITH(write_vtu(path, mesh, std::array{named("p\x01", 1), named("p\xff", 2)}),
                    Contains("two fields have the name 'p\ufffd'"));
}

TEST_CASE("solids of VTU are split, surfaces skipped, pieces joined, and fields follow",
          "[m2m][io]") {
  const Scratch scratch;
  const std::vector<Point> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},  {0, 0, 1},
                                {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {.5, .5, 2}};
  Cells first{cube,
              {{12, {0, 1, 2, 3, 4, 5, 6, 7}}, {9, {0, 1, 2, 3}}, {14, {4, 5, 6, 7, 8}}},
              {"p", 1, {0, 1, 2, 3, 4, 5, 6, 7, 8}},
              {"rho", 2, {10, 11, 20, 21, 30, 31}}};
  // A voxel, the two wedges of its bottom in both orders, and a quadratic tetrahedron.
  std::vector<Point> quadratic{{0, 0, 0},   {1, 0, 0},  {0, 1, 0},  {0, 0, 1},   {.5, 0, 0},
                               {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}};
  Cells second{cube,
               {{11, {0, 1, 3, 2, 4, 5, 7, 6}}, {13, {0, 1, 2, 4, 5, 6}}, {13, {0, 3, 2, 4, 7, 6}}},
               {"p", 1, {9, 10, 11, 12, 13, 14, 15, 16, 17}},
               {"rho", 2, {40, 41, 50, 51, 60, 61}}};
  Cells third{quadratic,
              {{24, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}},
              {"p", 1, std::vector(10, 0.5)},
              {"rho", 2, {70, 71}}};
  const auto written = [&](const char* name) {
    Vtu vtu({"raw", "appended", false});
    const std::string inside = piece_of(vtu, first) + piece_of(vtu, second) + piece_of(vtu, third);
    return scratch.write(name, "\xEF\xBB\xBF" + vtu.file(inside));  // behind a byte order mark
  };
  const std::string path = written("solids.vtu");
  const TetMesh mesh = read_mesh(path);
  CHECK(skipped_text(mesh) == "1 quad");
  CHECK(split_text(mesh) ==
        "2 HEX8 into 12 tetrahedra, 1 PYRAMID5 into 2 tetrahedra, 2 WEDGE6 into 6 tetrahedra, "
        "1 TET10 into 8 tetrahedra");
  double volume = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    CHECK(signed_volume(mesh, t) > 0);
    volume += signed_volume(mesh, t);
  }
  CHECK(volume == Approx(1 + 1.0 / 3 + 1 + 1 + 1.0 / 6).epsilon(1e-14));
  const FieldFile file(path);
  const Field p = file.vertex_field(mesh, "p", 0);
  CHECK(p.values[17] == 17);
  CHECK(p.values[27] == 0.5);
  const Field rho = file.tet_field(mesh, "rho", 0);
  CHECK(rho.values.size() == 2 * 28);
  CHECK(rho.values[2 * 5] == 10);
  CHECK(rho.values[2 * 6 + 1] == 31);  // the quad between is skipped
  CHECK(rho.values[2 * 13] == 40);
  CHECK(rho.values[2 * 14] == 50);
  CHECK(rho.values[2 * 19] == 60);
  CHECK(rho.values[2 * 27 + 1] == 71);

  // Lagrange cells of degree 1 and 2 have the same points.
  for (Cells* piece : {&first, &second, &third})
    for (auto& cell : piece->cells)
      for (const auto& [type, lagrange] :
           {std::pair{12, 72}, {13, 73}, {14, 74}, {24, 71}, {9, 70}})
        if (cell.first == type) cell.first = lagrange;
  const std::string other = written("lagrange.vtu");
  const TetMesh same = read_mesh(other);
  CHECK(same.tets == mesh.tets);
  CHECK(skipped_text(same) == "1 Lagrange quadrilateral");
  CHECK(FieldFile(other).tet_field(same, "rho", 0).values == rho.values);
  second.cells[1] = {73, {0, 1, 2, 4, 5}};
  CHECK_THROWS_WITH(read_mesh(written("five.vtu")),
                    Contains("cell 1 is a Lagrange wedge (VTK type 73) of 5 points; of volumes"));
}

TEST_CASE("comments and CDATA in VTU are no numbers, and no format", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  Cells cells = cells_of(mesh);
  cells.at_points = {"p", 1, {1, 2, 3, 4, 5, 6, 7, 8}};
  const std::string text = vtu_of(cells), numbers = "1 2 3 4 5 6 7 8 ";
  const std::size_t at = text.find(numbers);
  REQUIRE(at != std::string::npos);
  for (const char* written :
       {"<!-- Pa > 0 -->1 2 3 4 5 6 7 8", "1 2 3 <!-- <b> --> 4 5 6 7 8<!---->",
        "<![CDATA[1 2 3 4 5 6]]><![CDATA[ 7 8]]>",
        "1 2 3 4 5 6 7 8 <InformationKey name=\"a\"><Value>9</Value></InformationKey>"}) {
    CAPTURE(written);
    const std::string path =
        scratch.write("marks.vtu", std::string(text).replace(at, numbers.size(), written));
    CHECK(FieldFile(path).vertex_field(read_mesh(path), "p", 0).values == cells.at_points.values);
  }
  const std::string licence = "<!-- " + std::string(2000, 'x') + " <VTK> -->\n";
  CHECK(read_mesh(scratch.write("long.vtu", licence + text.substr(text.find("<VTKFile")))).tets ==
        mesh.tets);
  CHECK_THROWS_WITH(read_mesh(scratch.write("a.html", "<!-- <VTKFile --><p>")),
                    Contains("is neither"));
}

TEST_CASE("an array of VTU without components is refused only if it is asked for", "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({1});
  Cells cells = cells_of(mesh);
  cells.at_points = {"p", 1, std::vector<double>(8, 3)};
  cells.in_cells = {"q", 0, {}};
  const std::string path = scratch.write("none.vtu", vtu_of(cells));
  const FieldFile file(path);
  CHECK(file.vertex_field(mesh, "p", 0).values == cells.at_points.values);
  CHECK_THROWS_WITH(file.tet_field(mesh, "q", 0), Contains("'q' has 0 components"));
}

TEST_CASE("ghost cells of VTU are skipped, and reported", "[m2m][io]") {
  const Scratch scratch;
  Cells cells = cells_of(kuhn_mesh({1}));
  cells.in_cells = {"vtkGhostType", 1, {0, 1, 0, 2, 8, 32}};  // 2 is HIGHCONNECTIVITYCELL
  const std::string path = scratch.write("ghosts.vtu", vtu_of(cells));
  const TetMesh mesh = read_mesh(path);
  CHECK(mesh.n_tets() == 3);
  CHECK(skipped_text(mesh) == "3 ghost");
  CHECK(FieldFile(path).tet_field(mesh, "vtkGhostType", 0).values == std::vector<double>{0, 0, 2});
  cells.in_cells = {"vtkGhostLevels", 1, {0, 1, 0, 2, 0, 0}};  // of older files
  CHECK(skipped_text(read_mesh(scratch.write("levels.vtu", vtu_of(cells)))) == "2 ghost");
}

TEST_CASE("what VTU can hold and is not supported is refused by name", "[m2m][io]") {
  const Scratch scratch;
  const auto refusal = [&](const std::string& bytes) {
    const std::string path = scratch.write("bad.vtu", bytes);
    const std::string message = message_of([&] { read_all(path); });
    CHECK_THAT(message, Catch::StartsWith(path + ": "));
    CHECK(message.find('\n') == std::string::npos);
    return message;
  };
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
  };
  const Cells cells = cells_of(kuhn_mesh({1}));
  const std::string good = vtu_of(cells);
  CHECK_THAT(refusal(replaced(good, "UnstructuredGrid\"", "PolyData\"")),
             Contains("holds a VTK PolyData"));
  CHECK_THAT(refusal(replaced(vtu_of(cells, styles[3]), "ZLib", "LZ4")),
             Contains("is compressed by vtkLZ4DataCompressor"));
  CHECK_THAT(refusal(replaced(vtu_of(cells, styles[1]), "Int64", "Complex")),
             Contains("is of type Complex"));
  CHECK_THAT(refusal(replaced(good, "format=\"ascii\"", "format=\"utf\"")),
             Contains("has format utf"));
  CHECK_THAT(refusal(replaced(good, "\"types\"", "\"kinds\"")), Contains("array types is missing"));
  CHECK_THAT(refusal(replaced(good, "NumberOfCells=\"6\"", "NumberOfCells=\"7\"")),
             Contains("'types' has 6 numbers instead of 7"));
  CHECK_THAT(
      refusal(replaced(good, "NumberOfPoints=\"8\"", "NumberOfPoints=\"99999999999999999999\"")),
      Contains("has no number NumberOfPoints"));
  CHECK_THAT(refusal(replaced(good, "</VTKFile>", "")), Contains("</VTKFile> is missing"));
  const std::size_t begin = good.find("<Points>") + 8, end = good.find("</Points>");
  CHECK_THAT(refusal(std::string(good).insert(end, good.substr(begin, end - begin))),
             Contains("a Piece has 2 arrays of Points instead of one"));
  Cells bad = cells;
  bad.cells[2].second[1] = 8;
  CHECK_THAT(refusal(vtu_of(bad)), Contains("cell 2 names point 8 of 8"));
  bad.cells[2] = {42, {0, 1, 2, 3}};
  CHECK_THAT(refusal(vtu_of(bad)), Contains("cell 2 is a polyhedron (VTK type 42)"));
  bad.cells[2] = {25, std::vector<std::int64_t>(20, 1)};
  CHECK_THAT(refusal(vtu_of(bad)), Contains("quadratic hexahedron"));
  bad.cells[2] = {99, {0}};
  CHECK_THAT(refusal(vtu_of(bad)), Contains("VTK type 99"));
  bad.cells[2] = {10, {0, 1, 2}};
  CHECK_THAT(refusal(vtu_of(bad)), Contains("cell 2 of type tetra has 3 vertices"));
}

TEST_CASE("VTU files that are cut or have flipped bits give one line of error", "[m2m][io]") {
  const TetMesh mesh = kuhn_mesh({1});
  Cells cells = cells_of(mesh);
  cells.at_points = awkward_field("u", mesh.n_points(), 3, 1);
  cells.in_cells = awkward_field("rho", mesh.n_tets(), 1, 2);
  for (const Style& style : styles) {
    CAPTURE(style.name);
    const std::string bytes = vtu_of(cells, style);
    const std::size_t n_cuts = bytes.size() / 64;
    tess::test::damage_everywhere("cut.vtu", bytes, n_cuts, 400, read_all);
  }
  const Scratch scratch;
  const std::string path = scratch.path("whole.vtu");
  write_vtu(path, mesh, std::array{cells.at_points}, std::array{cells.in_cells});
  const std::string bytes = slurp(path);
  tess::test::damage_everywhere("cut.vtu", bytes, bytes.size() / 64, 1500, read_all);
}

TEST_CASE("VTK reads what is written, and every encoding that VTK writes is read",
          "[m2m][io][.][vtk]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({4, 0.2});
  const std::array at_vertices{awkward_field("u", mesh.n_points(), 3, 1)};
  const std::array in_tets{awkward_field("rho", mesh.n_tets(), 1, 2)};
  write_vtu(scratch.path("out.vtu"), mesh, at_vertices, in_tets, 0.5);
  const std::string command =
      fmt::format("/usr/bin/python3 {}/io/rewrite_vtu.py {}", TESS_M2M_TESTS, scratch.path(""));
  REQUIRE(std::system(command.c_str()) == 0);
  for (const char* mode : {"ascii", "binary", "appended_raw", "appended_base64"}) {
    for (const char* more : {"", "_zlib", "_wide", "_big"}) {
      CAPTURE(mode, more);
      const std::string path = scratch.path(fmt::format("{}{}.vtu", mode, more));
      const TetMesh read = read_mesh(path);
      CHECK(read.points == mesh.points);
      CHECK(read.tets == mesh.tets);
      const FieldFile file(path);
      const bool is_text = std::string(mode) == "ascii";
      const auto same = [&](const Field& got, const Field& want) {
        if (!is_text) return bits_of(got.values) == bits_of(want.values);
        return got.values.size() == want.values.size();  // VTK writes text with few digits of NaN
      };
      CHECK(same(file.vertex_field(read, "u", 0), at_vertices[0]));
      CHECK(same(file.tet_field(read, "rho", 0), in_tets[0]));
    }
  }
}
