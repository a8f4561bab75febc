// The pieces and arrays of a VTU file (VTK XML UnstructuredGrid), or of a legacy VTK file, which are
// decoded when they are asked for. Arrays may be ascii, binary (base64) or appended (raw or base64), of either byte
// order, and compressed by zlib; other compressors are refused by name.
#pragma once

#include "m2m/io/file_bytes.hpp"
#include "m2m/io/vtu/vtu_data.hpp"
#include "runtime/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tess::m2m {

struct VtuArray {
  std::string name, type, format;
  std::size_t n_components = 1;
  std::size_t offset = 0;   ///< in the appended data
  std::string_view text{};  ///< ascii or base64, and what stands behind it
};

struct VtuPiece {
  std::size_t n_points = 0, n_cells = 0;
  std::vector<VtuArray> points{}, cells{}, point_data{}, cell_data{};
};

struct XmlTag;

class VtuFile {
 public:
  /// Reads the list of arrays. `bytes`, the content at `path`, must outlive the object. Throws
  /// Error (bad_file) if the file is truncated or damaged or of another kind.
  VtuFile(const std::string& path, std::string_view bytes);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const std::vector<VtuPiece>& pieces() const noexcept { return pieces_; }
  /// The array TimeValue; 0 if there is none.
  [[nodiscard]] double time() const noexcept { return time_; }

  /// The array of this name. Throws Error (bad_file) if there is none.
  [[nodiscard]] const VtuArray& array(const std::vector<VtuArray>& arrays,
                                      std::string_view name) const;
  static constexpr std::size_t any = std::numeric_limits<std::size_t>::max();
  /// Its numbers. Throws Error (bad_file) unless there are `n`, and (bad_value) if an integer does
  /// not fit a double.
  [[nodiscard]] std::vector<double> reals(const VtuArray& array, std::size_t n) const;
  [[nodiscard]] std::vector<std::int64_t> integers(const VtuArray& array, std::size_t n) const;

  template <class... Parts>
  [[noreturn]] void damaged(const Parts&... parts) const {
    fail(ErrorCode::bad_file, path_, ": is truncated or damaged (", parts...,
         "); write the mesh again");
  }

 private:
  /// The place in the list of arrays that the constructor reads.
  struct Scan {
    std::string_view bytes;
    std::vector<VtuArray> field_data{};
    std::vector<VtuArray>* section = nullptr;  // null: DataArrays here are skipped
    VtuArray* array = nullptr;                 // the open one
    const char* text_begin = nullptr;          // of its numbers
  };
  /// An attribute that is a number. Without `otherwise` it must be there.
  [[nodiscard]] std::size_t size_of(const XmlTag& tag, std::string_view name,
                                    std::optional<std::size_t> otherwise) const;
  class Legacy;
  void read_legacy(std::string_view bytes);
  void read_root(const XmlTag& tag);
  [[nodiscard]] std::vector<VtuArray>& section_of_piece(std::string_view name);
  void read_array(const XmlTag& tag, Scan& scan) const;
  /// True if the file is complete behind the data.
  [[nodiscard]] bool read_appended(const XmlTag& tag, std::string_view bytes);

  template <class T>
  [[nodiscard]] std::vector<T> numbers(const VtuArray& array, std::size_t n) const;
  template <class T>
  [[nodiscard]] std::vector<T> numbers_of_text(const VtuArray& array) const;

  std::string path_;
  VtuEncoding encoding_;
  std::vector<VtuPiece> pieces_;
  std::string_view appended_;
  bool appended_is_base64_ = false;
  double time_ = 0;
  std::deque<std::string> owned_{};  // what arrays of a legacy file show
};

/// True for the first line of a legacy VTK file.
[[nodiscard]] inline bool is_legacy_vtk(std::string_view bytes) {
  return bytes.starts_with("# vtk DataFile Version");
}

/// A file that is open.
struct OpenVtuFile {
  std::unique_ptr<FileBytes> bytes;  ///< null: the caller has them
  std::unique_ptr<VtuFile> file;
};

/// The files that hold the pieces of a mesh: of a .pvtu (PUnstructuredGrid) those that it names,
/// otherwise the file itself. `bytes`, the content at `path`, must outlive them. Throws Error
/// (bad_file) that names the file that is missing, truncated, damaged or of another kind.
[[nodiscard]] std::vector<OpenVtuFile> open_vtu_files(const std::string& path,
                                                      std::string_view bytes);

}  // namespace tess::m2m
