// The format of a mesh file, by its first bytes; its extension does not matter.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tess::m2m {

enum class FileFormat : std::uint8_t { exodus, gmsh, vtu };

/// Throws Error (bad_file) for any other format.
[[nodiscard]] FileFormat file_format(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
