#include "m2m/io/file_format.hpp"

#include "runtime/core/error.hpp"

namespace tess::m2m {

extern const FileFormat exodus_format, gmsh_format, vtu_format;

const FileFormat& file_format(const std::string& path, std::string_view bytes) {
  std::string names;
  for (const FileFormat* format : {&exodus_format, &gmsh_format, &vtu_format}) {
    if (format->is_format_of(bytes)) return *format;
    names.append(names.empty() ? "" : ", nor ").append(format->name);
  }
  fail(ErrorCode::bad_file, path, ": is neither ", names, "; convert it to one of these formats");
}

}  // namespace tess::m2m
