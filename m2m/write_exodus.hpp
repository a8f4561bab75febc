// Writes a mesh with fields as ExodusII (NetCDF-3, 64-bit offsets) with one time step, for example
// for ParaView. The file appears complete or not at all: it is written under another name in the
// same folder, then renamed.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <span>
#include <string>

namespace tess::m2m {

/// Writes the mesh with its blocks, side sets and node sets. `vertex_fields` (n_points rows) become
/// nodal variables, `tet_fields` (n_tets rows) element variables. A field of three components
/// becomes NAME_x, NAME_y, NAME_z; any other number of components gives NAME_1, NAME_2, …
/// Throws Error (bad_file, environment) with the path if the file cannot be written; no partial
/// file remains. Not reentrant: one thread at a time.
void write_exodus(const std::string& path, const TetMesh& mesh,
                  std::span<const Field> vertex_fields, std::span<const Field> tet_fields = {});

}  // namespace tess::m2m
