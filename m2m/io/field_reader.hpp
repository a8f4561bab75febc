// The fields of a file, as one reader per format lists and reads them. FieldFile (field_file.hpp)
// chooses the reader, finds fields by name, and words the errors.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tess::m2m {

/// Where a field has its values.
enum class FieldPlace : std::uint8_t { vertices, tets };

/// A field that a file has.
struct FileField {
  std::string name;
  FieldPlace place = FieldPlace::vertices;
  std::size_t n_components = 1;
  bool is_part = false;  ///< one component of a vector, which is listed as a whole as well
};

class FieldReader {
 public:
  FieldReader() = default;
  virtual ~FieldReader() = default;
  FieldReader(const FieldReader&) = delete;
  FieldReader& operator=(const FieldReader&) = delete;

  [[nodiscard]] const std::vector<FileField>& fields() const noexcept { return fields_; }
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }
  /// The values of fields()[field] at times()[step], for the vertices or tetrahedra of `mesh`,
  /// which was read from the same file. Row-major. Throws Error if values are missing.
  [[nodiscard]] virtual std::vector<double> read(const TetMesh& mesh, std::size_t field,
                                                 std::size_t step) const = 0;

 protected:
  std::vector<FileField> fields_;
  std::vector<double> times_;  // per step
};

/// The values of tetrahedra, from those of the elements that they are part of. `values`: elements
/// with a volume in the order of the file × n_components, row-major. Throws Error (bad_mesh) if the
/// mesh has other elements.
[[nodiscard]] std::vector<double> values_of_tets(const TetMesh& mesh, std::vector<double> values,
                                                 std::size_t n_components, const std::string& path);

/// The name with a question mark for each control character, so that errors have one line.
[[nodiscard]] std::string clean_name(std::string_view name);

/// Throws Error (bad_mesh) unless the mesh has as many vertices as the file.
void check_n_points(const TetMesh& mesh, std::int64_t n_vertices, const std::string& path);

/// `path` and `bytes`, the content of the file, must outlive the reader.
[[nodiscard]] std::unique_ptr<FieldReader> exodus_fields(const std::string& path,
                                                         std::string_view bytes);
[[nodiscard]] std::unique_ptr<FieldReader> gmsh_fields(const std::string& path,
                                                       std::string_view bytes);

}  // namespace tess::m2m
