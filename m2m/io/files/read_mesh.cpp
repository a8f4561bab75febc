#include "m2m/read_mesh.hpp"

#include "m2m/io/file_bytes.hpp"
#include "m2m/io/file_format.hpp"
#include "m2m/kuhn.hpp"

namespace tess::m2m {

TetMesh read_mesh(const std::string& name) {
  TetMesh mesh;
  if (name.starts_with("kuhn:")) {
    mesh = kuhn_mesh(parse_kuhn(name));
  } else {
    const FileBytes file(name);
    mesh = file_format(name, file.view()).read_mesh(name, file.view());
  }
  validate(mesh);
  return mesh;
}

}  // namespace tess::m2m
