// Reads the tetrahedra of an ExodusII file (NetCDF-3 or NetCDF-4) through libexodusII. The library
// trusts the lengths a file declares, so that a damaged NetCDF-3 header is refused before
// (io/netcdf_header.hpp); the metadata of NetCDF-4 is guarded by HDF5's own checksums. One thread
// at a time: the library is not reentrant.
#pragma once

#include "m2m/mesh.hpp"

#include <string>
#include <string_view>

namespace tess::m2m {

/// All blocks of TET4 elements, in file order, as one mesh, with the file's side and node sets.
/// Blocks of surface, line and point elements are skipped and counted. Throws Error (bad_file) on
/// damage, (bad_mesh) on other solids or fewer than three dimensions. `bytes`: the content of
/// the file at `path`.
[[nodiscard]] TetMesh read_exodus(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
