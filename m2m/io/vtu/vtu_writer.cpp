#include "m2m/io/vtu/vtu_writer.hpp"

#include "m2m/io/new_file.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/escape.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <fmt/core.h>
#include <vector>

namespace tess::m2m {
namespace {

static_assert(std::endian::native == std::endian::little, "the header of the file says so");

/// The XML in front of the data, and the place of each array in the data.
class Head {
 public:
  void line(const std::string& text) { text_ += text + "\n"; }
  void array(const char* type, const std::string& name, std::size_t n_components,
             std::uint64_t n_bytes) {
    line(
        fmt::format("        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
                    "format=\"appended\" offset=\"{}\"/>",
                    type, xml_text(name), n_components, offset_));
    offset_ += sizeof(std::uint64_t) + n_bytes;
  }
  void fields(const char* section, std::span<const Field> all, std::size_t n_rows,
              const std::string& path) {
    line(fmt::format("      <{}>", section));
    for (const Field& field : all) {
      TESS_CHECK(field.values.size() == n_rows * field.n_components, "field ", field.name,
                 ": expected ", n_rows, " × ", field.n_components, " values, got ",
                 field.values.size());
      if (field.name.empty()) fail(ErrorCode::bad_value, path, ": a field has no name; name it");
      for (const Field* other = all.data(); other != &field; ++other)
        if (xml_characters(other->name) == xml_characters(field.name))
          fail(ErrorCode::bad_value, path, ": two fields have the name '",
               xml_characters(field.name), "'; give each field a name of its own");
      array("Float64", field.name, field.n_components, field.values.size() * sizeof(double));
    }
    line(fmt::format("      </{}>", section));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::uint64_t offset_ = 0;
};

template <class T>
void append(NewFile& file, std::span<const T> numbers) {
  const std::uint64_t n_bytes = numbers.size_bytes();
  file.write_numbers(std::span(&n_bytes, 1));
  file.write_numbers(numbers);
}

}  // namespace

void write_vtu_file(const std::string& path, const TetMesh& mesh,
                    std::span<const Field> vertex_fields, std::span<const Field> tet_fields,
                    double time) {
  Head head;
  head.line("<?xml version=\"1.0\"?>");
  head.line(
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">");
  head.line("  <UnstructuredGrid>");
  head.line(
      fmt::format("    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" "
                  "NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n    </FieldData>",
                  time));
  head.line(fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", mesh.n_points(),
                        mesh.n_tets()));
  head.fields("PointData", vertex_fields, mesh.n_points(), path);
  head.fields("CellData", tet_fields, mesh.n_tets(), path);
  head.line("      <Points>");
  head.array("Float64", "Points", 3, mesh.n_points() * sizeof(Point));
  head.line("      </Points>\n      <Cells>");
  const auto n_corners = static_cast<std::size_t>(mesh.dimension) + 1;
  head.array("Int32", "connectivity", 1, mesh.n_tets() * n_corners * sizeof(VertexId));
  head.array("Int64", "offsets", 1, mesh.n_tets() * sizeof(std::int64_t));
  head.array("UInt8", "types", 1, mesh.n_tets());
  head.line("      </Cells>\n    </Piece>\n  </UnstructuredGrid>");
  head.line("  <AppendedData encoding=\"raw\">");

  NewFile file(path);
  file.write(head.text());
  file.write("_");
  for (const std::span<const Field> fields : {vertex_fields, tet_fields})
    for (const Field& field : fields) append(file, std::span(field.values));
  append(file, std::span(mesh.points));
  std::vector<VertexId> corners;
  std::vector<std::int64_t> ends;
  for (const Tet& cell : mesh.tets) {
    corners.insert(corners.end(), cell.begin(), cell.begin() + mesh.dimension + 1);
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  append(file, std::span<const VertexId>(corners));
  append(file, std::span<const std::int64_t>(ends));
  constexpr std::array<std::uint8_t, 4> types{1, 3, 5, 10};  // per dimension: line, triangle, tetra
  append(file, std::span<const std::uint8_t>(std::vector(mesh.n_tets(), types.at(n_corners - 1))));
  file.write("\n  </AppendedData>\n</VTKFile>\n");
  file.finish();
}

}  // namespace tess::m2m
