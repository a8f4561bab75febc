// Reads the tetrahedra of a gmsh file, MSH 2.0 to 2.2 or 4.1, ASCII or binary. Points, lines and surfaces
// are skipped and counted, as are sections that may hold a part of the mesh. $Nodes and $Elements may
// be repeated. Every count is checked against the remaining bytes before memory is
// allocated, so a damaged file gives one line of error.
#pragma once

#include "m2m/io/gmsh/gmsh_format.hpp"
#include "m2m/mesh.hpp"

#include <string>
#include <string_view>

namespace tess::m2m {

/// `bytes`: the content of the file at `path`. Throws Error (bad_file) if the file is damaged,
/// (bad_mesh) if it has volume elements of another type. Node tags may have gaps of any size;
/// vertices keep the order of the file. Of copies of an element, one per physical group as in version
/// 2.2, one is read. `tags`: if not null, gets the tags, of copies the last.
[[nodiscard]] TetMesh read_gmsh(const std::string& path, std::string_view bytes,
                                GmshTags* tags = nullptr);

}  // namespace tess::m2m
