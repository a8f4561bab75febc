// Lists the arrays of a legacy VTK file (VTK file formats, docs.vtk.org), ASCII or BINARY, of version
// 1 to 5.1, as if it were a VTU file: the readers of meshes and fields are the same.
#include "m2m/io/field_reader.hpp"
#include "m2m/io/vtu/vtu_file.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace tess::m2m {
namespace {

/// The type in the terms of VTU, and its bytes; none for text and bits.
std::pair<const char*, std::size_t> type_of(std::string_view name) {
  struct Known {
    std::string_view name;
    const char* type;
    std::size_t n_bytes;
  };
  constexpr std::array known{Known{"double", "Float64", 8},
                             Known{"float", "Float32", 4},
                             Known{"int", "Int32", 4},
                             Known{"vtkidtype", "Int32", 4},
                             Known{"vtktypeint64", "Int64", 8},
                             Known{"vtktypeint32", "Int32", 4},
                             Known{"vtktypeuint64", "UInt64", 8},
                             Known{"vtktypeuint32", "UInt32", 4},
                             Known{"unsigned_int", "UInt32", 4},
                             Known{"long", "Int64", 8},
                             Known{"unsigned_long", "UInt64", 8},
                             Known{"short", "Int16", 2},
                             Known{"unsigned_short", "UInt16", 2},
                             Known{"char", "Int8", 1},
                             Known{"signed_char", "Int8", 1},
                             Known{"unsigned_char", "UInt8", 1}};
  const auto found = std::ranges::find(known, name, &Known::name);
  return found == known.end() ? std::pair("", std::size_t{0})
                              : std::pair(found->type, found->n_bytes);
}

/// Names of arrays have %20 for a blank.
std::string decoded(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto code = name[i] == '%' && i + 2 < name.size()
                          ? parse_number<int>(name.substr(i + 1, 2), 16)
                          : std::nullopt;
    out += code ? static_cast<char>(*code) : name[i];
    if (code) i += 2;
  }
  return clean_name(out);
}

}  // namespace

/// Reads a file in order.
class VtuFile::Legacy {
 public:
  Legacy(VtuFile& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  void read() {
    line();  // the version, and a title
    line();
    const std::string mode = word();
    binary_ = mode == "binary";
    if (!binary_ && mode != "ascii") file_.damaged("it is neither ASCII nor BINARY");
    file_.encoding_.big_endian = binary_;
    file_.pieces_.emplace_back();
    for (std::string keyword = word(); !keyword.empty(); keyword = word()) section(keyword);
    if (!has_grid_) file_.damaged("it has no DATASET");
    if (piece().cells.size() < 3 && piece().n_cells > 0) file_.damaged("CELLS or CELL_TYPES miss");
  }

 private:
  VtuPiece& piece() { return file_.pieces_.back(); }

  void section(const std::string& keyword) {
    if (keyword == "dataset") {
      const std::string grid = word();
      if (grid != "unstructured_grid")
        fail(ErrorCode::bad_mesh, file_.path_, ": holds a VTK dataset '", clean_name(grid),
             "'; only unstructured_grid is supported: convert it");
      has_grid_ = true;
    } else if (keyword == "points") {
      piece().n_points = count(3);
      piece().points.push_back(values("Points", word(), piece().n_points, 3));
    } else if (keyword == "cells") {
      cells();
    } else if (keyword == "cell_types") {
      const std::size_t n = count(1);
      piece().n_cells = n;
      piece().cells.push_back(values("types", "int", n, 1));
    } else if (keyword == "point_data" || keyword == "cell_data") {
      section_ = keyword[0] == 'p' ? &piece().point_data : &piece().cell_data;
      n_rows_ = count(0);
    } else if (keyword == "metadata") {
      skip_metadata();
    } else if (keyword == "field") {
      word();
      const std::size_t n_arrays = count(1);
      for (std::size_t i = 0; i < n_arrays; ++i) array_of_field();
    } else if (section_ == nullptr) {
      file_.damaged("'", clean_name(keyword.substr(0, 40)), "' is no section");
    } else {
      attribute(keyword);
    }
  }

  /// Up to the next empty line.
  void skip_metadata() {
    line();  // the rest of this one
    while (!line().empty()) {
    }
  }

  /// In version 5 as in VTU; before, each cell begins with its number of vertices.
  void cells() {
    const std::size_t n = count(1), size = count(1);
    const std::size_t begin = at_;
    if (word() == "offsets") {
      VtuArray ends = values("offsets", word(), n, 1);
      const std::vector<std::int64_t> all = file_.integers(ends, n);
      if (all.empty() || all[0] != 0) file_.damaged("OFFSETS do not begin with 0");
      keep("offsets", {all.begin() + 1, all.end()});
      if (word() != "connectivity") file_.damaged("CONNECTIVITY is missing");
      piece().cells.push_back(values("connectivity", word(), size, 1));
      return;
    }
    at_ = begin;
    const std::vector<std::int64_t> all = file_.integers(values("cells", "int", size, 1), size);
    std::vector<std::int64_t> ends, vertices;
    for (std::size_t i = 0; i < size;) {
      const std::int64_t n_vertices = all[i++];
      if (n_vertices < 0 || static_cast<std::size_t>(n_vertices) > size - i)
        file_.damaged("cell ", ends.size(), " has ", n_vertices, " vertices");
      for (std::int64_t k = 0; k < n_vertices; ++k) vertices.push_back(all[i++]);
      ends.push_back(static_cast<std::int64_t>(vertices.size()));
    }
    if (ends.size() != n) file_.damaged(n, " cells announced, ", ends.size(), " found");
    keep("offsets", ends);
    keep("connectivity", vertices);
  }

  /// An array with numbers that are not so in the file.
  void keep(const char* name, const std::vector<std::int64_t>& numbers) {
    std::string& bytes = file_.owned_.emplace_back();
    for (const std::int64_t number : numbers)
      for (int shift = 56; shift >= 0; shift -= 8)
        bytes += static_cast<char>(file_.encoding_.big_endian ? number >> shift
                                                              : number >> (56 - shift));
    piece().cells.push_back({name, "Int64", "legacy", 1, 0, bytes});
  }

  void array_of_field() {
    const std::string name = decoded(raw_word());
    if (name == "METADATA") {  // of the array before
      skip_metadata();
      return array_of_field();
    }
    const std::size_t n_components = count(1), n_rows = count(1);
    VtuArray array = values(name, word(), n_rows, n_components);
    if (name == "TIME" || name == "TimeValue") {
      const std::vector<double> times = file_.reals(array, VtuFile::any);
      if (!times.empty()) file_.time_ = times[0];
    }
    if (section_ == nullptr) return;
    if (n_rows != n_rows_) file_.damaged("'", name, "' has ", n_rows, " rows of ", n_rows_);
    section_->push_back(std::move(array));
  }

  void attribute(const std::string& keyword) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 7> known{{{"scalars", 1},
                                                                             {"vectors", 3},
                                                                             {"normals", 3},
                                                                             {"tensors", 9},
                                                                             {"tensors6", 6},
                                                                             {"global_ids", 1},
                                                                             {"pedigree_ids", 1}}};
    const auto kind = std::ranges::find(known, keyword, [](const auto& k) { return k.first; });
    const std::string name = decoded(raw_word());
    const std::string bytes = binary_ ? "unsigned_char" : "float";
    if (keyword == "lookup_table") {
      (void)values(name, bytes, count(4), 4);
    } else if (keyword == "color_scalars") {
      section_->push_back(values(name, bytes, n_rows_, count(0)));
    } else if (keyword == "texture_coordinates") {
      const std::size_t n_components = count(0);
      section_->push_back(values(name, word(), n_rows_, n_components));
    } else if (kind == known.end()) {
      file_.damaged("'", clean_name(keyword.substr(0, 40)), "' is no attribute");
    } else {
      const std::string type = word();
      std::size_t n_components = kind->second;
      if (keyword == "scalars") {
        const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
        const std::string_view rest = bytes_.substr(at_, end - at_);
        if (rest.find_first_not_of(" \r") != std::string_view::npos) n_components = count(0);
        const std::size_t end_of_line = at_;
        if (word() == "lookup_table")
          word();
        else
          at_ = end_of_line;
      }
      section_->push_back(values(name, type, n_rows_, n_components));
    }
  }

  /// The array that stands here; passes over its numbers.
  VtuArray values(const std::string& name, const std::string& type, std::size_t n_rows,
                  std::size_t n_components) {
    const auto [vtu_type, n_bytes] = type_of(type);
    if (n_bytes == 0)
      fail(ErrorCode::bad_file, file_.path_, ": array '", name, "' is of type ",
           clean_name(type.substr(0, 40)), "; only numbers of whole bytes are supported");
    const std::size_t left = bytes_.size() - at_;
    const std::size_t each = binary_ ? n_bytes : 2;
    if (n_components > 1000 || n_rows > (left + 1) / each / std::max<std::size_t>(n_components, 1))
      file_.damaged("array '", name, "' of ", n_rows, " × ", n_components, " does not fit");
    const std::size_t n = n_rows * n_components;
    if (binary_) {
      line();  // the rest of the line of the keyword
      if (n * n_bytes > bytes_.size() - at_) file_.damaged("array '", name, "' is cut off");
    }
    const std::size_t begin = at_;
    if (binary_)
      at_ += n * n_bytes;
    else
      for (std::size_t i = 0; i < n; ++i)
        if (raw_word().empty()) file_.damaged("array '", name, "' has ", i, " of ", n, " numbers");
    return {name,         vtu_type, binary_ ? "legacy" : "ascii",
            n_components, 0,        bytes_.substr(begin, at_ - begin)};
  }

  static bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
  std::string_view raw_word() {
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
    return bytes_.substr(begin, at_ - begin);
  }
  /// Keywords and types are in upper or lower case.
  std::string word() {
    std::string out(raw_word());
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
  }
  /// The rest of the line, without blanks at its ends.
  std::string_view line() {
    const std::size_t begin = std::min(at_, bytes_.size());
    const std::size_t end = std::min(bytes_.find('\n', begin), bytes_.size());
    at_ = std::min(end + 1, bytes_.size());
    std::string_view out = bytes_.substr(begin, end - begin);
    while (!out.empty() && is_blank(out.back())) out.remove_suffix(1);
    return out;
  }
  /// A number of things of which each takes at least so many bytes.
  std::size_t count(std::size_t bytes_each) {
    const std::string text = word();
    const auto n = parse_number<std::size_t>(text);
    if (!n || (bytes_each > 0 && *n > (bytes_.size() - at_) / bytes_each + 1))
      file_.damaged("'", clean_name(text.substr(0, 40)), "' is no count");
    return *n;
  }

  VtuFile& file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool binary_ = false, has_grid_ = false;
  std::vector<VtuArray>* section_ = nullptr;  // of the attributes that follow
  std::size_t n_rows_ = 0;                    // of each of them
};

void VtuFile::read_legacy(std::string_view bytes) {
  Legacy(*this, bytes).read();
}

}  // namespace tess::m2m
