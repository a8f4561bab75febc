// Reads the tetrahedra of a VTU file (VTK XML UnstructuredGrid, vtu_file.hpp), or of the files that a
// .pvtu names. Hexahedra, voxels, wedges, pyramids and quadratic tetrahedra are split, also if they
// are written as Lagrange cells; cells without a volume are skipped and counted. Pieces are joined
// in the order of the file; their points are not merged.
#pragma once

#include "m2m/mesh.hpp"

#include <string>
#include <string_view>

namespace tess::m2m {

/// `bytes`: the content of the file at `path`. Throws Error (bad_file) if the file is damaged,
/// (bad_mesh) if it has other solids.
[[nodiscard]] TetMesh read_vtu(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
