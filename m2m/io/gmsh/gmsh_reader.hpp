// Reads the cells of a gmsh file, MSH 2.0 to 2.2, 4.0 or 4.1, ASCII or binary. Its physical groups
// become blocks, and side sets: those of surfaces in a mesh of volumes, those of lines in a mesh of
// surfaces. Other elements of lower dimension are skipped and counted, as are sections that may hold
// a part of the mesh. $Nodes and $Elements may be repeated. Every count is checked against the
// remaining bytes before memory is allocated, so a damaged file gives one line of error.
#pragma once

#include "m2m/io/gmsh/gmsh_format.hpp"
#include "m2m/mesh.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace tess::m2m {

/// Reads the elements of one dimension; there are none of a higher one. `bytes`: the content of the
/// file at `path`. Throws Error (bad_file) if the file is damaged, (bad_mesh) if it has elements of
/// the dimension of another type. Node tags may have gaps of any size; vertices keep the order of the
/// file. Of copies of an element, one per physical group as in version 2.2, one is read. `tags`: if
/// not null, gets the tags, of copies the last.
[[nodiscard]] TetMesh read_gmsh(const std::string& path, std::string_view bytes,
                                std::int32_t dimension = 3, GmshTags* tags = nullptr);

}  // namespace tess::m2m
