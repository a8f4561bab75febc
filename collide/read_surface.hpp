// Surfaces of triangles from files: OBJ, PLY and STL, by the ending of the name.
// Every face of a file becomes its triangles (tess::dn::add_polygon), degenerate and duplicate ones
// included, in the order of the file; Surface::remarks names what is skipped. No vertex is merged or
// moved.
//
// OBJ, PLY (ASCII, binary of either byte order) and STL as text are read in double precision;
// binary STL holds single precision only. All readers are our own: those of Assimp 5.2 round to
// single precision, refuse ".5" (OBJ), end in a segmentation fault if the file is truncated (PLY),
// and leave out vertices of a facet that has more than three (STL).
#pragma once

#include "collide/dn_field/surface.hpp"

#include <string>
#include <string_view>

namespace tess::dn {

/// True if the name ends in .obj, .ply or .stl, in any case.
[[nodiscard]] bool names_surface(std::string_view path);

/// Throws tess::Error (bad_file, bad_mesh) that names the file and what is wrong: it cannot be
/// read, has another ending, is truncated or holds no triangles, a vertex is not finite, or a face
/// has fewer than three vertices or one that does not exist.
[[nodiscard]] Surface read_surface(const std::string& path);

}  // namespace tess::dn
