// Writes a mesh with fields as VTU (VTK XML UnstructuredGrid), for ParaView and VTK. All numbers
// are appended as raw binary, so they are read back bit for bit. The file appears complete or not
// at all: it is written under another name in the same folder, then renamed.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <span>
#include <string>

namespace tess::m2m {

/// `vertex_fields` (n_points rows) become PointData, `tet_fields` (n_tets rows) CellData, with the
/// components that they have; `time` becomes TimeValue. Blocks and sets are left out, as VTU has
/// none. What XML cannot hold of a name becomes U+FFFD (runtime/core/escape.hpp). Throws Error
/// (bad_value) for fields without a name of their own, also if names become equal by that,
/// (bad_file) with the path if the file cannot be written.
void write_vtu(const std::string& path, const TetMesh& mesh, std::span<const Field> vertex_fields,
               std::span<const Field> tet_fields = {}, double time = 0);

}  // namespace tess::m2m
