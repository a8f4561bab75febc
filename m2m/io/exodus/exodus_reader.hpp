// Reads the tetrahedra of an ExodusII file (NetCDF-3 or NetCDF-4) through libexodusII. The library
// trusts the lengths that a file declares, so netcdf_header.hpp refuses a damaged NetCDF-3 header
// first. HDF5 guards the metadata of NetCDF-4 by checksums. The library is not reentrant: one
// thread at a time.
#pragma once

#include "m2m/mesh.hpp"

#include <string>
#include <string_view>

namespace tess::m2m {

/// Returns all blocks of TET4 elements in file order as one mesh, with the side and node sets.
/// Blocks of surface, line and point elements are skipped and counted. Throws Error (bad_file) if
/// the file is damaged, (bad_mesh) if it has other solids or fewer than three dimensions. `bytes`:
/// the content of the file at `path`.
[[nodiscard]] TetMesh read_exodus(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
