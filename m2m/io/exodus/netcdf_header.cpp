#include "m2m/io/exodus/netcdf_header.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <utility>

namespace tess::m2m {
namespace {

constexpr std::uint64_t padded(std::uint64_t n) {
  return n + (4 - n % 4) % 4;
}

class HeaderReader {
 public:
  HeaderReader(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  NetcdfHeader read() {
    version_ = at_ + 4 <= bytes_.size() ? static_cast<unsigned char>(bytes_[3]) : 0;
    if (version_ != 1 && version_ != 2 && version_ != 5)
      damaged("unknown NetCDF version ", version_);
    at_ = 4;
    n_records_ = count();
    const bool is_unknown = n_records_ == (wide() ? UINT64_MAX : UINT32_MAX);
    if (is_unknown) n_records_ = 0;
    dimensions();
    // libexodusII takes it as a number.
    for (const NetcdfDimension& dimension : dimensions_)
      if (is_unknown && dimension.length == 0)
        damaged("the number of records is unknown, since the file was not closed");
    attributes(true);
    variables();
    records_inside();
    return {std::move(dimensions_), std::move(variables_), n_records_};
  }

 private:
  [[nodiscard]] bool wide() const { return version_ == 5; }

  template <class... Parts>
  [[noreturn]] void damaged(const Parts&... parts) const {
    fail(ErrorCode::bad_file, path_, ": is truncated or damaged (NetCDF header, byte ", at_, ": ",
         parts..., "); write the mesh again");
  }

  void need(std::uint64_t n) const {
    if (n > bytes_.size() - at_)
      damaged("expected ", n, " bytes, only ", bytes_.size() - at_, " are left");
  }

  std::uint64_t integer(std::size_t n_bytes) {
    need(n_bytes);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < n_bytes; ++i)
      value = value << 8U | static_cast<unsigned char>(bytes_[at_ + i]);
    at_ += n_bytes;
    return value;
  }
  std::uint64_t count() { return integer(wide() ? 8 : 4); }
  std::uint64_t word() { return integer(4); }

  std::string name() {
    const std::uint64_t length = count();
    need(length);
    std::string text(bytes_.substr(at_, length));
    for (const char c : text)
      if (static_cast<unsigned char>(c) < ' ') damaged("a name with a control character");
    skip(length);
    return text;
  }

  /// Skips n bytes and their padding to a multiple of four.
  void skip(std::uint64_t n) {
    need(n);
    need(padded(n));
    at_ += padded(n);
  }

  /// Reads the tag and the length of a list. An absent list is two zeros.
  std::uint64_t list(std::uint64_t tag, std::uint64_t bytes_an_item) {
    const std::uint64_t found = word();
    const std::uint64_t n = count();
    if (found != tag && !(found == 0 && n == 0)) damaged("expected list ", tag, ", found ", found);
    if (n > (bytes_.size() - at_) / bytes_an_item)
      damaged("a list of ", n, " items exceeds the file");
    return n;
  }

  std::uint64_t size_of_type(std::uint64_t type) const {
    constexpr std::array<std::uint64_t, 12> sizes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    if (type == 0 || type >= sizes.size() || (!wide() && type > 6)) damaged("unknown type ", type);
    return sizes[type];
  }

  void dimensions() {
    const std::uint64_t n = list(10, 8);
    std::set<std::string> names;  // libexodusII finds dimensions by name
    for (std::uint64_t i = 0; i < n; ++i) {
      std::string called = name();
      const std::uint64_t length = count();
      if (length > UINT64_MAX / 2) damaged("dimension ", called, " of length ", length);
      if (!names.insert(called).second) damaged("two dimensions are called ", called);
      dimensions_.push_back({std::move(called), length});
    }
  }

  void attributes(bool global) {
    const std::uint64_t n = list(12, 12);
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::string called = name();
      const std::uint64_t size = size_of_type(word());
      const std::uint64_t length = count();
      if (length > bytes_.size()) damaged("attribute ", called, " of length ", length);
      // ex_open reads these into single variables.
      constexpr std::array<std::string_view, 7> scalars{
          "version",   "api_version",  "floating_point_word_size", "floating point word size",
          "file_size", "int64_status", "maximum_name_length"};
      for (const std::string_view scalar : scalars) {
        if (global && called == scalar && length != 1)
          damaged("attribute ", called, " has ", length, " values");
      }
      if (!global && called == "elem_type") {
        if (length > 33)  // libexodusII copies it into a buffer of this size
          damaged("attribute ", called, " has ", length, " characters; at most 32 are possible");
        element_type_ = bytes_.substr(at_, length);
        for (char& c : element_type_)
          c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      }
      skip(length * size);
    }
  }

  void variables() {
    const std::uint64_t n = list(11, 20);
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::string called = name();
      const std::uint64_t rank = count();
      if (rank > 1024 || rank > dimensions_.size() + 8)
        damaged("variable ", called, " of ", rank, " dimensions");
      std::vector<std::size_t> shape;
      for (std::uint64_t d = 0; d < rank; ++d) {
        const std::uint64_t id = count();
        if (id >= dimensions_.size())
          damaged("variable ", called, " has dimension ", id, " of ", dimensions_.size());
        shape.push_back(id);
      }
      element_type_.clear();
      attributes(false);
      const std::uint64_t type = word();
      const std::uint64_t size = size_of_type(type);
      count();  // the declared size saturates in large files; the shape gives the size
      const std::uint64_t begin = integer(version_ == 1 ? 4 : 8);
      inside(called, shape, size, begin);
      expected_shape(called, shape);
      variables_.push_back({called, std::move(shape), type, begin});
    }
  }

  /// The bytes of a variable, or of one record of it.
  [[nodiscard]] std::uint64_t bytes_of(const NetcdfVariable& variable) const {
    std::uint64_t n_bytes = size_of_type(variable.type);
    for (const std::size_t d : variable.shape)
      if (dimensions_[d].length != 0) n_bytes *= dimensions_[d].length;
    return n_bytes;
  }

  /// Records hold a part of every record variable. The library reads zeros for records beyond the
  /// end of the file.
  void records_inside() const {
    std::uint64_t n_variables = 0, record_bytes = 0;
    const auto is_record = [this](const NetcdfVariable& variable) {
      return !variable.shape.empty() && dimensions_[variable.shape[0]].length == 0;
    };
    if (n_records_ < 2) return;
    for (const NetcdfVariable& variable : variables_) {
      if (!is_record(variable)) continue;
      ++n_variables;
      record_bytes += padded(bytes_of(variable));  // each is at most the size of the file
    }
    for (const NetcdfVariable& variable : variables_) {
      if (!is_record(variable)) continue;
      const std::uint64_t n_bytes = bytes_of(variable);
      const std::uint64_t step = n_variables == 1 ? n_bytes : record_bytes;
      const std::uint64_t left = bytes_.size() - variable.begin - n_bytes;
      if (n_records_ - 1 > left / std::max<std::uint64_t>(step, 1))
        damaged("variable ", variable.name, " has ", n_records_, " records, which exceed the file");
    }
  }

  void inside(const std::string& called, const std::vector<std::size_t>& shape, std::uint64_t size,
              std::uint64_t begin) const {
    std::uint64_t n_bytes = size;
    for (std::size_t d = 0; d < shape.size(); ++d) {
      std::uint64_t length = dimensions_[shape[d]].length;
      if (length == 0) {
        if (d != 0) damaged("variable ", called, " has the record dimension at position ", d);
        if (n_records_ == 0) return;
        length = 1;  // one record at least
      }
      if (__builtin_mul_overflow(n_bytes, length, &n_bytes))
        damaged("variable ", called, " is too large");
    }
    if (begin > bytes_.size() || n_bytes > bytes_.size() - begin) {
      damaged("variable ", called, " ends at byte ", begin, " + ", n_bytes, " of ", bytes_.size());
    }
  }

  void expected_shape(const std::string& called, const std::vector<std::size_t>& shape) const {
    std::vector<std::string> wanted;
    const std::string_view all = called;
    if (all == "coordx" || all == "coordy" || all == "coordz") {
      wanted = {"num_nodes"};
    } else if (all == "coord") {
      wanted = {"num_dim", "num_nodes"};
    } else if (all == "eb_prop1" || all == "eb_status") {
      wanted = {"num_el_blk"};
    } else if (all.starts_with("connect")) {
      const std::string block(all.substr(7));
      wanted = {"num_el_in_blk" + block, "num_nod_per_el" + block};
      if (shape.size() == 1 && element_type_.starts_with("NSIDED"))
        wanted.erase(wanted.begin());  // the vertices of all polygons
    } else if (all == "time_whole") {
      wanted = {"time_step"};
    } else if (all == "vals_nod_var") {
      wanted = {"time_step", "num_nod_var", "num_nodes"};
    } else if (all.starts_with("vals_nod_var")) {
      wanted = {"time_step", "num_nodes"};
    } else if (all.starts_with("vals_elem_var") && all.find("eb") != std::string_view::npos) {
      wanted = {"time_step", "num_el_in_blk" + std::string(all.substr(all.find("eb") + 2))};
    } else if (all == "elem_var_tab") {
      wanted = {"num_el_blk", "num_elem_var"};
    } else if (all == "name_nod_var") {
      wanted = {"num_nod_var", "*"};
    } else if (all == "name_elem_var") {
      wanted = {"num_elem_var", "*"};
    } else {
      return;
    }
    bool right = wanted.size() == shape.size();
    for (std::size_t d = 0; right && d < shape.size(); ++d)
      right = wanted[d] == "*" || dimensions_[shape[d]].name == wanted[d];
    if (!right) damaged("variable ", called, " has other dimensions than ExodusII defines");
  }

  const std::string& path_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  unsigned version_ = 0;
  std::uint64_t n_records_ = 0;
  std::string element_type_;  // of the present variable, in upper case
  std::vector<NetcdfDimension> dimensions_;
  std::vector<NetcdfVariable> variables_;
};

}  // namespace

NetcdfHeader read_netcdf_header(const std::string& path, std::string_view bytes) {
  return HeaderReader(path, bytes).read();
}

}  // namespace tess::m2m
