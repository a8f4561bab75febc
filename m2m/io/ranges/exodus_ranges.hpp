// Ranges of an ExodusII file.
#pragma once

#include "m2m/io/ranges/mesh_ranges.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace tess::m2m {

/// Null unless all solids of the file are TET4. `bytes`: the content of the file at `path`, in
/// NetCDF-3. Throws Error (bad_file) if it is damaged. The library is not reentrant, so the PEs of
/// a process take turns.
[[nodiscard]] std::unique_ptr<MeshRanges> open_exodus_ranges(const std::string& path,
                                                             std::string_view bytes);

}  // namespace tess::m2m
