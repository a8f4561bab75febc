// The PLY format (Turk, "The PLY polygon file format", 1994): a header that lists elements and
// their properties, then the elements one after the other, as text or binary. Of the elements,
// `vertex` (x, y, z), `face` (a list of vertices) and `tristrips` (likewise; -1 ends a strip) are
// taken; others are skipped with a remark. What is not used is not read as a number.
#include "collide/io/formats.hpp"
#include "runtime/base/open_file.hpp"
#include "runtime/base/words.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <sstream>
#include <utility>

namespace tess::dn {
namespace {

enum class Type : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array type_names{
    TypeName{"char", Type::i8},     TypeName{"int8", Type::i8},     TypeName{"uchar", Type::u8},
    TypeName{"uint8", Type::u8},    TypeName{"short", Type::i16},   TypeName{"int16", Type::i16},
    TypeName{"ushort", Type::u16},  TypeName{"uint16", Type::u16},  TypeName{"int", Type::i32},
    TypeName{"int32", Type::i32},   TypeName{"uint", Type::u32},    TypeName{"uint32", Type::u32},
    TypeName{"float", Type::f32},   TypeName{"float32", Type::f32}, TypeName{"double", Type::f64},
    TypeName{"float64", Type::f64},
};

struct Property {
  std::string name;
  Type type{};
  bool is_list = false;
  Type count_type{};
};
struct ElementKind {
  std::string name;
  std::uint64_t n = 0;
  std::vector<Property> properties;
};
constexpr std::string_view blanks = " \t\r\n";
enum class Encoding : std::uint8_t { ascii, little, big };

class PlyReader {
 public:
  explicit PlyReader(const std::string& path)
      : path_(path), text_(detail::without_byte_order_mark(detail::read_file(path, "a PLY file"))) {
    read_header();
  }

  Surface read() {
    for (const ElementKind& kind : kinds_) {
      kind_ = &kind;
      if (kind.n > 0 && kind.properties.empty()) refuse("has elements without properties");
      if (kind.name == "vertex") {
        read_vertices(kind);
      } else if (kind.name == "face" || kind.name == "tristrips") {
        read_faces(kind);
      } else {
        each(kind, [&] { std::ranges::for_each(kind.properties, [&](auto& p) { pass(p); }); });
        if (kind.n > 0) surface_.remarks["skipped " + kind.name.substr(0, 40)] += kind.n;
      }
    }
    if (encoding_ == Encoding::ascii && text_.find_first_not_of(blanks, at_) != std::string::npos)
      ++surface_.remarks["skipped text behind the last element"];
    // Now all vertices are known: they may stand behind the faces.
    for (const auto& [begin, n] : polygons_)
      add_polygon(surface_, std::span(corners_).subspan(begin, n));
    return std::move(surface_);
  }

 private:
  template <class... Parts>
  [[noreturn]] void refuse(const Parts&... parts) const {
    if (kind_ == nullptr) fail(ErrorCode::bad_file, path_, ": ", parts...);
    fail(ErrorCode::bad_file, path_, ": ", kind_->name, " ", number_, " of ", kind_->n, ": ",
         parts...);
  }

  std::string header_line() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) refuse("its header has no end_header; is the file truncated?");
    std::string line = text_.substr(at_, end - at_);
    at_ = end + 1;
    while (!line.empty() && detail::is_blank(line.back())) line.pop_back();
    return line;
  }

  Type type_of(const std::string& name) const {
    const auto* found = std::ranges::find(type_names, std::string_view(name), &TypeName::name);
    if (found == type_names.end()) refuse("unknown type '", name.substr(0, 40), "' in the header");
    return found->type;
  }

  void read_header() {
    if (!text_.starts_with("ply") || header_line() != "ply")
      refuse("is not a PLY file: it does not begin with the line 'ply'");
    for (std::string line = header_line(); line != "end_header"; line = header_line()) {
      std::istringstream words(line);
      std::string word, name;
      words >> word;
      if (word == "format") {
        words >> name;
        if (name == "ascii")
          encoding_ = Encoding::ascii;
        else if (name == "binary_little_endian")
          encoding_ = Encoding::little;
        else if (name == "binary_big_endian")
          encoding_ = Encoding::big;
        else
          refuse("unknown format '", name.substr(0, 40), "'");
      } else if (word == "element") {
        ElementKind kind;
        if (!(words >> kind.name >> kind.n)) refuse("not understood: '", line.substr(0, 80), "'");
        kinds_.push_back(kind);
      } else if (word == "property") {
        Property property;
        words >> name;
        if (name == "list") {
          property.is_list = true;
          words >> name;
          property.count_type = type_of(name);
          words >> name;
        }
        property.type = type_of(name);
        if (!(words >> property.name) || kinds_.empty())
          refuse("not understood: '", line.substr(0, 80), "'");
        kinds_.back().properties.push_back(property);
      }
    }
    line_end_ = text_.size();
    if (encoding_ == Encoding::ascii) has_rows_ = n_rows() == n_elements();
  }

  [[nodiscard]] std::uint64_t n_elements() const {
    std::uint64_t n = 0;
    for (const ElementKind& kind : kinds_) n += kind.n;
    return n;
  }
  /// The lines behind the header that are not blank.
  [[nodiscard]] std::uint64_t n_rows() const {
    std::uint64_t n = 0;
    for (std::size_t at = text_.find_first_not_of(blanks, at_); at < text_.size();
         at = text_.find_first_not_of(blanks, text_.find('\n', at)))
      ++n;
    return n;
  }

  /// Calls read() for each element. What stands behind it in its row of text is left out: some
  /// programs write more numbers than they announce.
  void each(const ElementKind& kind, const auto& read) {
    for (number_ = 0; number_ < kind.n; ++number_) {
      if (has_rows_) {
        at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
        line_end_ = std::min(text_.find('\n', at_), text_.size());
      }
      read();
      if (!has_rows_) continue;
      if (text_.find_first_not_of(blanks, at_) < line_end_)
        ++surface_.remarks["rows with more numbers than the header announces"];
      at_ = line_end_;
    }
  }

  /// The next number of the file. Every number of a PLY file is a double, exactly.
  double next(Type type) {
    if (encoding_ == Encoding::ascii) return next_word();
    switch (type) {
      case Type::i8:
        return next_as<std::int8_t>();
      case Type::u8:
        return next_as<std::uint8_t>();
      case Type::i16:
        return next_as<std::int16_t>();
      case Type::u16:
        return next_as<std::uint16_t>();
      case Type::i32:
        return next_as<std::int32_t>();
      case Type::u32:
        return next_as<std::uint32_t>();
      case Type::f32:
        return next_as<float>();
      case Type::f64:
        return next_as<double>();
    }
    return 0;
  }

  template <class T>
  double next_as() {
    std::array<char, sizeof(T)> bytes{};
    if (text_.size() - at_ < sizeof(T)) refuse("the file ends here; it is truncated");
    std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if ((encoding_ == Encoding::little) != (std::endian::native == std::endian::little))
      std::ranges::reverse(bytes);
    return static_cast<double>(std::bit_cast<T>(bytes));
  }

  std::string_view take_word() {
    at_ = std::min(text_.find_first_not_of(blanks, at_), line_end_);
    if (at_ == text_.size()) refuse("the file ends here; it is truncated");
    if (at_ == line_end_) refuse("its line ends before all that the header announces");
    const std::size_t end = std::min(text_.find_first_of(blanks, at_), text_.size());
    const std::string_view word = std::string_view(text_).substr(at_, end - at_);
    at_ = end;
    return word;
  }
  double next_word() {
    const std::string_view word = take_word();
    double value = 0;
    if (!detail::to_number(word, value)) refuse("'", word.substr(0, 40), "' is not a number");
    return value;
  }

  std::uint64_t next_count(const Property& property) {
    if (!property.is_list) return 1;
    const double n = next(property.count_type);
    if (!(n >= 0) || n != static_cast<double>(static_cast<std::uint32_t>(std::min(n, 1e9))))
      refuse("a list of ", n, " numbers");
    return static_cast<std::uint64_t>(n);
  }

  void pass(const Property& property) {
    for (std::uint64_t left = next_count(property); left > 0; --left)
      encoding_ == Encoding::ascii ? (void)take_word() : (void)next(property.type);
  }

  void read_vertices(const ElementKind& kind) {
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    for (const std::string_view axis : axes)
      if (std::ranges::find(kind.properties, axis, &Property::name) == kind.properties.end())
        refuse("vertices have no property ", axis);
    surface_.vertices.reserve(surface_.vertices.size() +
                              std::min<std::uint64_t>(kind.n, text_.size() / 3));
    each(kind, [&] {
      Vec3 at{};
      for (const Property& property : kind.properties) {
        double* const to = property.is_list           ? nullptr
                           : property.name == axes[0] ? &at.x
                           : property.name == axes[1] ? &at.y
                           : property.name == axes[2] ? &at.z
                                                      : nullptr;
        if (to != nullptr)
          *to = next(property.type);
        else
          pass(property);
      }
      surface_.vertices.push_back(at);
    });
  }

  void read_faces(const ElementKind& kind) {
    const auto is_corners = [](const Property& property) {
      return property.is_list &&
             (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    if (std::ranges::none_of(kind.properties, is_corners))
      refuse(kind.name == "face" ? "faces" : "strips", " have no list vertex_indices");
    each(kind, [&] {
      for (const Property& property : kind.properties) {
        if (!is_corners(property))
          pass(property);
        else if (kind.name == "face")
          read_polygon(property);
        else
          read_strips(property);
      }
    });
  }

  std::uint32_t corner_of(double v) const {
    if (!(v >= 0 && v < 4294967296.0) || v != std::floor(v))
      refuse("vertex ", v, " does not exist");
    return static_cast<std::uint32_t>(v);
  }

  void read_polygon(const Property& property) {
    const std::uint64_t n = next_count(property);
    if (n < 3) refuse("has ", n, " vertices; a face needs three");
    polygons_.push_back({corners_.size(), n});
    for (std::uint64_t i = 0; i < n; ++i) corners_.push_back(corner_of(next(property.type)));
  }

  /// Each vertex of a strip makes a triangle with the two before it, every other one turned round.
  /// Where a vertex is repeated it makes none: so strips are joined.
  void read_strips(const Property& property) {
    std::array<std::uint32_t, 2> last{};
    std::size_t n_before = 0;
    for (std::uint64_t left = next_count(property); left > 0; --left) {
      const double v = next(property.type);
      if (v == -1) {
        n_before = 0;
        continue;
      }
      const std::uint32_t corner = corner_of(v);
      if (n_before >= 2 && last[0] != last[1] && corner != last[0] && corner != last[1]) {
        const std::size_t first = n_before % 2;
        polygons_.push_back({corners_.size(), 3});
        corners_.insert(corners_.end(), {last[first], last[1 - first], corner});
      }
      last = {last[1], corner};
      ++n_before;
    }
  }

  const std::string& path_;
  std::string text_;
  std::size_t at_ = 0;
  std::size_t line_end_ = 0;  // of the row that is read; of the text if it has no rows
  bool has_rows_ = false;     // a line of text per element
  Encoding encoding_ = Encoding::ascii;
  std::vector<ElementKind> kinds_;
  const ElementKind* kind_ = nullptr;  // that is being read, and the number of its element
  std::uint64_t number_ = 0;
  Surface surface_;
  std::vector<std::pair<std::size_t, std::size_t>> polygons_;  // first corner and number
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Surface read_ply(const std::string& path) {
  return PlyReader(path).read();
}

}  // namespace tess::dn
