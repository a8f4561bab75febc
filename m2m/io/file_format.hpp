// The formats of mesh files. Each is described beside its reader, and file_format.cpp lists all.
#pragma once

#include "m2m/io/field_reader.hpp"
#include "m2m/mesh.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tess::m2m {

/// `path` and `bytes`, the content of the file at `path`, must outlive a reader of fields. The
/// readers throw Error (bad_file) if the file is damaged, (bad_mesh) if it has other elements
/// of the dimension.
struct FileFormat {
  std::string_view name;  ///< for refusals, with an article: "a VTU file"
  /// By the first bytes; the extension does not matter.
  bool (*is_format_of)(std::string_view bytes);
  /// Reads the elements of one dimension as cells; there are none of a higher one.
  TetMesh (*read_mesh)(const std::string& path, std::string_view bytes, std::int32_t dimension);
  std::unique_ptr<FieldReader> (*read_fields)(const std::string& path, std::string_view bytes);
};

/// Throws Error (bad_file) for a format that is not listed.
[[nodiscard]] const FileFormat& file_format(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
