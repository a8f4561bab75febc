#include "m2m/read_mesh.hpp"

#include "m2m/io/file_bytes.hpp"
#include "m2m/io/file_format.hpp"
#include "m2m/kuhn.hpp"

#include <cstdint>
#include <string_view>
#include <utility>

namespace tess::m2m {
namespace {

/// The cells of the highest dimension that the file has. Without any, the mesh names what it skipped.
TetMesh read_cells(const std::string& path, std::string_view bytes) {
  const FileFormat& format = file_format(path, bytes);
  TetMesh mesh = format.read_mesh(path, bytes, 3);
  for (std::int32_t dimension = 2; dimension > 0 && mesh.tets.empty(); --dimension)
    if (TetMesh other = format.read_mesh(path, bytes, dimension); !other.tets.empty())
      mesh = std::move(other);
  return mesh;
}

}  // namespace

TetMesh read_mesh(const std::string& name) {
  TetMesh mesh;
  if (name.starts_with("kuhn:")) {
    mesh = kuhn_mesh(parse_kuhn(name));
  } else {
    const FileBytes file(name);
    mesh = read_cells(name, file.view());
  }
  validate(mesh);
  return mesh;
}

}  // namespace tess::m2m
