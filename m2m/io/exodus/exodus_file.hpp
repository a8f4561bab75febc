// An ExodusII file that is open for reading, and checks of what the library returns. Readers of
// meshes and of fields build on it. The library is not reentrant: one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <exodusII.h>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tess::m2m {

/// What a file may have beside its blocks of elements, side sets and node sets. It is skipped, with
/// its count.
struct ExodusExtra {
  ex_inquiry what;
  const char* name;
};
inline constexpr std::array exodus_extras{
    ExodusExtra{EX_INQ_EDGE_BLK, "edge block"}, ExodusExtra{EX_INQ_FACE_BLK, "face block"},
    ExodusExtra{EX_INQ_EDGE_SETS, "edge set"}, ExodusExtra{EX_INQ_FACE_SETS, "face set"},
    ExodusExtra{EX_INQ_ELEM_SETS, "element set"}};

/// Reads coordinates of the nodes from `first` on, counted from 0, into `out`. Returns a code of
/// NetCDF. The library's own calls (6.02) take a variable that is the file's first for missing, and
/// give zeros.
[[nodiscard]] int read_exodus_axis(int id, std::size_t axis, std::int64_t first,
                                   std::span<double> out);

class ExodusFile {
 public:
  /// Opens the file at `path`, whose content is `bytes`. `path` must outlive the object. Throws
  /// Error (bad_file) if the file is damaged.
  ExodusFile(const std::string& path, std::string_view bytes);
  ~ExodusFile();
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

 protected:
  [[noreturn]] void damaged(const char* call, int code) const;
  /// A warning (a positive code) is an error, too: the library gives one, and no numbers, for what
  /// the file lacks.
  void check(int code, const char* call) const {
    if (code != 0) damaged(call, code);
  }
  [[nodiscard]] std::int64_t inquire(int what) const;
  /// A count that an honest file of this size can have; otherwise the file is damaged.
  [[nodiscard]] std::int64_t count(int what, const char* name) const;
  /// No count in the file exceeds this: its size in NetCDF-3. Compressed NetCDF-4 holds more than
  /// its size shows, but never 1 000 times more.
  [[nodiscard]] std::int64_t most() const noexcept { return most_; }
  /// Without this call the library cuts names to 32 characters, also those of files that have more.
  void set_name_length() const;
  /// The numbers of the blocks or sets in file order. Throws if a number occurs twice.
  [[nodiscard]] std::vector<std::int64_t> ids_of(ex_entity_type type, std::int64_t n) const;
  [[nodiscard]] std::string name_of(ex_entity_type type, std::int64_t id) const;
  /// Number, type and sizes of a block of elements. The type is in upper case.
  struct ElementBlock {
    std::int64_t id = 0;
    std::string type;
    std::int64_t n_elements = 0;
    std::int64_t n_vertices_each = 0;
  };
  /// `k`: its place in the file, from 1 on.
  [[nodiscard]] ElementBlock block_of(std::int64_t id, std::size_t k) const;
  /// Refuses a variable that is not time steps × `n`, as ExodusII defines it. The library would
  /// read other numbers in their place.
  void check_shape(const std::string& variable, std::int64_t n) const;
  /// Refuses a variable of other lengths. The library fills a buffer with all of a variable, also
  /// if that is longer than the dimension that the buffer has its size from.
  void check_lengths(const std::string& variable, const std::vector<std::int64_t>& lengths) const;

  const std::string& path_;
  int id_ = -1;

 private:
  /// Of the dimensions of a variable. None if it is in another layout, or missing.
  [[nodiscard]] std::optional<std::vector<std::int64_t>> lengths_of(
      const std::string& variable) const;
  std::int64_t most_ = 0;
};

}  // namespace tess::m2m
