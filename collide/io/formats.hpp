// The readers of the formats beside OBJ. Each gives what the file holds; read_surface() checks it.
#pragma once

#include "collide/dn_field/surface.hpp"

#include <string>

namespace tess::dn {

/// Throws tess::Error (bad_file) that names the file, the element and the remedy.
[[nodiscard]] Surface read_ply(const std::string& path);
[[nodiscard]] Surface read_stl(const std::string& path);

}  // namespace tess::dn
