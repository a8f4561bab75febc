// Writes a mesh with fields as ExodusII (NetCDF-3, 64-bit offsets), one time step: what ParaView
// opens. The file appears whole or not at all: it is written beside its place under another name,
// and renamed.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <span>
#include <string>

namespace tess::m2m {

/// The mesh with its blocks, side and node sets. Nodal variables from `vertex_fields` (n_points
/// rows), element variables from `tet_fields` (n_tets rows); a field of several components becomes
/// NAME_1, NAME_2, …; three become NAME_x, NAME_y, NAME_z. Throws Error (bad_file, environment)
/// naming the path where it cannot be written; nothing is left behind then. One thread at a time.
void write_exodus(const std::string& path, const TetMesh& mesh,
                  std::span<const Field> vertex_fields, std::span<const Field> tet_fields = {});

}  // namespace tess::m2m
