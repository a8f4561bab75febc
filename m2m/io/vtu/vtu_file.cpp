#include "m2m/io/vtu/vtu_file.hpp"

#include "m2m/io/field_reader.hpp"
#include "m2m/io/text_number.hpp"
#include "m2m/io/vtu/xml_scanner.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>

namespace tess::m2m {
namespace {

std::string printable(std::string text) {
  if (text.size() > 80) text.resize(80);
  for (char& c : text) c = c < ' ' || c > '~' ? '?' : c;
  return text;
}

/// Behind blanks, comments and the marks of CDATA sections.
const char* next_text(const char* at, const char* end) {
  while (at != end) {
    const std::string_view rest(at, static_cast<std::size_t>(end - at));
    if (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')
      ++at;
    else if (rest.starts_with("<!--"))
      at += std::min(rest.find("-->"), rest.size() - 3) + 3;
    else if (rest.starts_with("<![CDATA["))
      at += 9;
    else if (rest.starts_with("]]>"))
      at += 3;
    else
      break;
  }
  return at;
}

/// The numbers of type `Stored` in `bytes`, as numbers of type T.
template <class T, class Stored>
std::vector<T> converted(const std::string& bytes, bool big_endian) {
  std::vector<T> out(bytes.size() / sizeof(Stored));
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::array<char, sizeof(Stored)> number;
    std::memcpy(number.data(), bytes.data() + i * sizeof(Stored), sizeof(Stored));
    if (big_endian) std::reverse(number.begin(), number.end());
    Stored value;
    std::memcpy(&value, number.data(), sizeof(Stored));
    if constexpr (std::is_floating_point_v<Stored> && !std::is_floating_point_v<T>) {
      // Ids in floating point; what is no number becomes an id that does not exist.
      out[i] = value >= -1 && value < 9e15 ? static_cast<T>(value) : T{-1};
    } else {
      out[i] = static_cast<T>(value);
    }
  }
  return out;
}

template <class T>
std::optional<std::vector<T>> converted(const std::string& type, const std::string& bytes,
                                        bool big_endian) {
  if (type == "Float64") return converted<T, double>(bytes, big_endian);
  if (type == "Float32") return converted<T, float>(bytes, big_endian);
  if (type == "Int64") return converted<T, std::int64_t>(bytes, big_endian);
  if (type == "UInt64") return converted<T, std::uint64_t>(bytes, big_endian);
  if (type == "Int32") return converted<T, std::int32_t>(bytes, big_endian);
  if (type == "UInt32") return converted<T, std::uint32_t>(bytes, big_endian);
  if (type == "Int16") return converted<T, std::int16_t>(bytes, big_endian);
  if (type == "UInt16") return converted<T, std::uint16_t>(bytes, big_endian);
  if (type == "Int8") return converted<T, std::int8_t>(bytes, big_endian);
  if (type == "UInt8") return converted<T, std::uint8_t>(bytes, big_endian);
  return std::nullopt;
}

}  // namespace

VtuFile::VtuFile(const std::string& path, std::string_view bytes) : path_(path) {
  if (is_legacy_vtk(bytes)) {
    read_legacy(bytes);
    return;
  }
  XmlScanner xml(bytes);
  Scan scan{.bytes = bytes};
  bool has_root = false, is_complete = false;
  while (const auto tag = xml.next()) {
    const bool opens = tag->kind != XmlTag::Kind::close;
    if (tag->name == "VTKFile") {
      if (!opens) {
        is_complete = true;
        break;
      }
      has_root = true;
      read_root(*tag);
    } else if (!has_root) {
      break;
    } else if (tag->name == "Piece" && opens) {
      pieces_.push_back({size_of(*tag, "NumberOfPoints", {}), size_of(*tag, "NumberOfCells", {})});
      scan.section = nullptr;
      scan.array = nullptr;
    } else if (tag->name == "FieldData") {
      scan.section = opens ? &scan.field_data : nullptr;
    } else if (tag->name == "Points" || tag->name == "Cells" || tag->name == "PointData" ||
               tag->name == "CellData") {
      std::vector<VtuArray>& section = section_of_piece(tag->name);
      scan.section = opens ? &section : nullptr;
    } else if (tag->name == "DataArray" && scan.section != nullptr) {
      read_array(*tag, scan);
    } else if (tag->name == "AppendedData" && opens) {
      is_complete = read_appended(*tag, bytes);
      break;
    }
  }
  if (!is_complete) damaged("</VTKFile> is missing behind byte ", xml.at());
  if (pieces_.empty()) damaged("it has no Piece");
  for (const VtuArray& found : scan.field_data)
    if (found.name == "TimeValue") {
      const std::vector<double> times = reals(found, any);
      if (!times.empty()) time_ = times[0];
    }
}

std::size_t VtuFile::size_of(const XmlTag& tag, std::string_view name,
                             std::optional<std::size_t> otherwise) const {
  const auto text = tag.attribute(name);
  if (!text && otherwise) return *otherwise;
  const auto value = text ? parse_number<std::size_t>(*text) : std::nullopt;
  if (!value) damaged(tag.name, " has no number ", name);
  return *value;
}

void VtuFile::read_root(const XmlTag& tag) {
  const std::string type = tag.attribute("type").value_or("");
  if (type != "UnstructuredGrid")
    fail(ErrorCode::bad_mesh, path_, ": holds a VTK ", printable(type),
         "; only UnstructuredGrid (.vtu, .pvtu) is supported: convert it");
  encoding_.big_endian = tag.attribute("byte_order").value_or("") == "BigEndian";
  encoding_.header_bytes = tag.attribute("header_type").value_or("") == "UInt64" ? 8 : 4;
  const std::string compressor = tag.attribute("compressor").value_or("");
  encoding_.zlib = compressor == "vtkZLibDataCompressor";
  if (!compressor.empty() && !encoding_.zlib)
    fail(ErrorCode::bad_file, path_, ": is compressed by ", printable(compressor),
         "; only vtkZLibDataCompressor is supported: write it with that one, or uncompressed");
}

std::vector<VtuArray>& VtuFile::section_of_piece(std::string_view name) {
  if (pieces_.empty()) damaged(name, " before Piece");
  VtuPiece& piece = pieces_.back();
  return name == "Points"      ? piece.points
         : name == "Cells"     ? piece.cells
         : name == "PointData" ? piece.point_data
                               : piece.cell_data;
}

void VtuFile::read_array(const XmlTag& tag, Scan& scan) const {
  if (tag.kind != XmlTag::Kind::close) {
    scan.section->push_back({clean_name(tag.attribute("Name").value_or("")),
                             tag.attribute("type").value_or(""),
                             tag.attribute("format").value_or("ascii"),
                             size_of(tag, "NumberOfComponents", 1), size_of(tag, "offset", 0)});
    scan.array = tag.kind == XmlTag::Kind::open ? &scan.section->back() : nullptr;
    scan.text_begin = scan.bytes.data() + tag.end;
  } else if (scan.array != nullptr) {
    scan.array->text = {scan.text_begin, tag.text_before.data() + tag.text_before.size()};
    scan.array = nullptr;
  }
}

bool VtuFile::read_appended(const XmlTag& tag, std::string_view bytes) {
  appended_is_base64_ = tag.attribute("encoding").value_or("") == "base64";
  const std::size_t begin = bytes.find('_', tag.end);
  const std::size_t end = bytes.rfind("</AppendedData>");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin)
    damaged("AppendedData has no end");
  appended_ = bytes.substr(begin + 1, end - begin - 1);
  return bytes.substr(end).find("</VTKFile>") != std::string_view::npos;
}

std::vector<OpenVtuFile> open_vtu_files(const std::string& path, std::string_view bytes) {
  std::vector<OpenVtuFile> out;
  XmlScanner xml(bytes);
  bool is_index = false, is_complete = false;
  while (const auto tag = xml.next()) {
    const bool opens = tag->kind != XmlTag::Kind::close;
    if (tag->name == "VTKFile" && opens)
      is_index = tag->attribute("type").value_or("") == "PUnstructuredGrid";
    if (!is_index) break;
    is_complete = is_complete || (tag->name == "VTKFile" && !opens);
    if (tag->name != "Piece" || !opens) continue;
    const std::string source = tag->attribute("Source").value_or("");
    const std::string part =
        (std::filesystem::path(path).parent_path() / source).lexically_normal().string();
    auto content = std::make_unique<FileBytes>(part);
    auto file = std::make_unique<VtuFile>(part, content->view());
    out.push_back({std::move(content), std::move(file)});
  }
  if (is_index && (!is_complete || out.empty()))
    fail(ErrorCode::bad_file, path, ": is truncated or damaged (",
         is_complete ? "it names no Piece" : "</VTKFile> is missing", "); write the mesh again");
  if (!is_index) out.push_back({nullptr, std::make_unique<VtuFile>(path, bytes)});
  return out;
}

const VtuArray& VtuFile::array(const std::vector<VtuArray>& arrays, std::string_view name) const {
  const VtuArray* found = nullptr;
  for (const VtuArray& array : arrays) {
    if (array.name != name) continue;
    if (found != nullptr)
      fail(ErrorCode::bad_value, path_, ": there are two arrays ", name,
           " in one section; give each a name of its own");
    found = &array;
  }
  if (found == nullptr) damaged("array ", name, " is missing");
  return *found;
}

template <class T>
std::vector<T> VtuFile::numbers_of_text(const VtuArray& array) const {
  std::vector<T> out;
  const char* at = array.text.data();
  const char* const end = at + array.text.size();
  while (true) {
    at = next_text(at, end);
    // The numbers end with the first tag behind them, such as an InformationKey.
    if (at == end || *at == '<') return out;
    T value{};
    const char* const last = read_text_number(at, end, value);
    if (last == at) damaged("array '", printable(array.name), "' has text that is no number");
    out.push_back(value);
    at = last;
  }
}

template <class T>
std::vector<T> VtuFile::numbers(const VtuArray& array, std::size_t n) const {
  const std::string name = printable(array.name);
  std::vector<T> out;
  if (array.format == "ascii") {
    out = numbers_of_text<T>(array);
  } else if (array.format == "legacy") {
    out = *converted<T>(array.type, std::string(array.text), encoding_.big_endian);
  } else if (array.format == "binary" || array.format == "appended") {
    const bool appended = array.format == "appended";
    if (appended && array.offset > appended_.size())
      damaged("array '", name, "' begins at byte ", array.offset, " of ", appended_.size());
    const char* const end = array.text.data() + array.text.size();
    const std::string_view here(next_text(array.text.data(), end), end);
    const auto bytes = vtu_payload(appended ? appended_.substr(array.offset) : here,
                                   !appended || appended_is_base64_, encoding_);
    if (!bytes) damaged("array '", name, "' cannot be decoded");
    auto found = converted<T>(array.type, *bytes, encoding_.big_endian);
    if (!found)
      fail(ErrorCode::bad_file, path_, ": array '", name, "' is of type ", printable(array.type),
           "; only Int8 to UInt64, Float32 and Float64 are supported");
    out = std::move(*found);
  } else {
    fail(ErrorCode::bad_file, path_, ": array '", name, "' has format ", printable(array.format),
         "; only ascii, binary and appended are supported");
  }
  if (n != any && out.size() != n)
    damaged("array '", name, "' has ", out.size(), " numbers instead of ", n);
  return out;
}

std::vector<double> VtuFile::reals(const VtuArray& array, std::size_t n) const {
  std::vector<double> out = numbers<double>(array, n);
  constexpr double inexact = 9007199254740992;  // 2^53
  if (array.type == "Int64" || array.type == "UInt64")
    for (const double value : out)
      if (!(std::abs(value) < inexact))
        fail(ErrorCode::bad_value, path_, ": array '", printable(array.name), "' of type ",
             array.type,
             " has a number from ±2^53 on, which a double does not hold exactly; write "
             "it as Float64, or choose other fields");
  return out;
}
std::vector<std::int64_t> VtuFile::integers(const VtuArray& array, std::size_t n) const {
  return numbers<std::int64_t>(array, n);
}

}  // namespace tess::m2m
