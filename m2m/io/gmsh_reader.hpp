// Reads the tetrahedra of a gmsh file, MSH 2.2 or 4.1, ASCII or binary. Points, lines and surfaces
// are passed over; volume elements other than the 4-vertex tetrahedron are refused by name. Every
// count is checked against the bytes that are left before anything is allocated, so that damaged
// files end in one line of error.
#pragma once

#include "m2m/mesh.hpp"

#include <string>
#include <string_view>

namespace tess::m2m {

/// The mesh in `bytes`, the content of the file at `path`. Throws Error (bad_file on damage,
/// bad_mesh on elements of another type). Node tags may have gaps of any size; vertices keep file
/// order.
[[nodiscard]] TetMesh read_gmsh(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
