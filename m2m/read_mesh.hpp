// Reads a mesh from a file, or generates one by name. The first bytes of the file decide its
// format, not its extension. Whatever the bytes are, the result is a mesh that has passed
// validate(), or an Error (bad_file, bad_mesh) of one line that names the file, the place in it and
// the remedy.
#pragma once

#include "m2m/mesh.hpp"

#include <string>

namespace tess::m2m {

/// `name` is "kuhn:8" or "kuhn:8@0.2" (kuhn.hpp), or the path of an ExodusII file, of a gmsh file
/// of version 2.0 to 2.2, 4.0 or 4.1, ASCII or binary, or of a VTK file (XML or legacy
/// UnstructuredGrid). Global ids follow the order of the file. Its cells are the elements of the
/// highest dimension that the file has: TetMesh::dimension.
[[nodiscard]] TetMesh read_mesh(const std::string& name);

}  // namespace tess::m2m
