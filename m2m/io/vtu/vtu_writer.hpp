// Writes VTU files: a whole mesh (write_vtu.hpp), or a part of one (write_pvtu.hpp).
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <span>
#include <string>

namespace tess::m2m {

/// As write_vtu().
void write_vtu_file(const std::string& path, const TetMesh& mesh,
                    std::span<const Field> vertex_fields, std::span<const Field> tet_fields = {},
                    double time = 0);

}  // namespace tess::m2m
