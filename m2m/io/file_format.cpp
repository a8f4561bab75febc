#include "m2m/io/file_format.hpp"

#include "runtime/core/error.hpp"

namespace tess::m2m {
namespace {

/// True if the first tag of an XML text, behind declarations and comments, is that of VTK.
bool is_vtk(std::string_view text) {
  std::size_t at = text.find_first_not_of(" \t\r\n");
  if (at == std::string_view::npos || text[at] != '<') return false;
  while (at != std::string_view::npos) {
    text.remove_prefix(at);
    const bool is_comment = text.starts_with("<!--");
    if (!is_comment && !text.starts_with("<?") && !text.starts_with("<!")) break;
    at = text.find('<', text.find(is_comment ? "-->" : ">"));
  }
  return text.starts_with("<VTKFile");
}

}  // namespace

FileFormat file_format(const std::string& path, std::string_view bytes) {
  if (bytes.starts_with("CDF") || bytes.starts_with("\x89HDF")) return FileFormat::exodus;
  if (bytes.starts_with("$")) return FileFormat::gmsh;
  if (is_vtk(bytes)) return FileFormat::vtu;
  fail(ErrorCode::bad_file, path,
       ": is neither an ExodusII file (NetCDF), nor a gmsh file (starts with $MeshFormat), nor a "
       "VTU "
       "file (starts with <VTKFile); convert it to one of these formats");
}

}  // namespace tess::m2m
