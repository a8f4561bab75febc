#include "m2m/write_vtu.hpp"

#include "m2m/io/vtu/vtu_writer.hpp"

namespace tess::m2m {

void write_vtu(const std::string& path, const TetMesh& mesh, std::span<const Field> vertex_fields,
               std::span<const Field> tet_fields, double time) {
  write_vtu_file(path, mesh, vertex_fields, tet_fields, time);
}

}  // namespace tess::m2m
