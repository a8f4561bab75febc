#include "m2m/read_mesh.hpp"

#include "m2m/io/exodus/exodus_reader.hpp"
#include "m2m/io/file_bytes.hpp"
#include "m2m/io/file_format.hpp"
#include "m2m/io/gmsh/gmsh_reader.hpp"
#include "m2m/io/vtu/vtu_reader.hpp"
#include "m2m/kuhn.hpp"

#include <string_view>

namespace tess::m2m {

TetMesh read_mesh(const std::string& name) {
  TetMesh mesh;
  if (name.starts_with("kuhn:")) {
    mesh = kuhn_mesh(parse_kuhn(name));
  } else {
    const FileBytes file(name);
    const std::string_view bytes = file.view();
    switch (file_format(name, bytes)) {
      case FileFormat::exodus:
        mesh = read_exodus(name, bytes);
        break;
      case FileFormat::gmsh:
        mesh = read_gmsh(name, bytes);
        break;
      case FileFormat::vtu:
        mesh = read_vtu(name, bytes);
        break;
    }
  }
  validate(mesh);
  return mesh;
}

}  // namespace tess::m2m
