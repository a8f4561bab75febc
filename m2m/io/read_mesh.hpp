// The door for meshes: a path, or the name of a generated one. The kind of file is told by its
// first bytes, never by its extension alone. Whatever the bytes are, a reader returns a mesh that
// passed validate() or throws Error (bad_file, bad_mesh) with one line naming the file, the place
// and the remedy.
#pragma once

#include "m2m/mesh.hpp"

#include <string>

namespace tess::m2m {

/// The mesh that `name` stands for: "kuhn:8" or "kuhn:8@0.2" (io/kuhn.hpp), an ExodusII file, or a
/// gmsh file of version 2.2 or 4.1, ASCII or binary. The global numbering is file order.
[[nodiscard]] TetMesh read_mesh(const std::string& name);

}  // namespace tess::m2m
