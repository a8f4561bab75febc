#include "m2m/io/file_format.hpp"

#include "runtime/core/error.hpp"

namespace tess::m2m {

FileFormat file_format(const std::string& path, std::string_view bytes) {
  if (bytes.starts_with("CDF") || bytes.starts_with("\x89HDF")) return FileFormat::exodus;
  if (bytes.starts_with("$")) return FileFormat::gmsh;
  if (bytes.substr(0, 1024).find("<VTKFile") != std::string_view::npos) return FileFormat::vtu;
  fail(ErrorCode::bad_file, path,
       ": is neither an ExodusII file (NetCDF), nor a gmsh file (starts with $MeshFormat), nor a "
       "VTU "
       "file (starts with <VTKFile); convert it to one of these formats");
}

}  // namespace tess::m2m
