#include "m2m/read_mesh.hpp"

#include "m2m/io/exodus_reader.hpp"
#include "m2m/io/file_bytes.hpp"
#include "m2m/io/gmsh_reader.hpp"
#include "m2m/kuhn.hpp"
#include "runtime/core/error.hpp"

#include <string_view>

namespace tess::m2m {

TetMesh read_mesh(const std::string& name) {
  TetMesh mesh;
  if (name.starts_with("kuhn:")) {
    mesh = kuhn_mesh(parse_kuhn(name));
  } else {
    const FileBytes file(name);
    const std::string_view bytes = file.view();
    if (bytes.starts_with("CDF") || bytes.starts_with("\x89HDF")) {
      mesh = read_exodus(name, bytes);
    } else if (bytes.starts_with("$")) {
      mesh = read_gmsh(name, bytes);
    } else {
      fail(ErrorCode::bad_file, name,
           ": is neither an ExodusII file (NetCDF) nor a gmsh file (starts with $MeshFormat); "
           "convert it to one of these formats");
    }
  }
  validate(mesh);
  return mesh;
}

}  // namespace tess::m2m
