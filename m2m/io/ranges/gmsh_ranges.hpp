// Ranges of a binary gmsh file of version 4.1.
#pragma once

#include "m2m/io/ranges/mesh_ranges.hpp"

#include <memory>
#include <string>

namespace tess::m2m {

/// Null unless the file is binary MSH 4.1 whose solids are tet4, and whose node tags are
/// consecutive in the order of the file. Only RangeCheck::all compares all tags; the ranges compare
/// their own. Throws Error (bad_file) if it is damaged.
[[nodiscard]] std::unique_ptr<MeshRanges> open_gmsh_ranges(const std::string& path,
                                                           RangeCheck check);

}  // namespace tess::m2m
