// The shapes of a scene file: built in, or triangles from an OBJ file.
#pragma once

#include "apps/particles/scene/json_reader.hpp"
#include "collide/dn_field/surface.hpp"

#include <string>

namespace particles {

/// A file that a scene in `folder` names.
[[nodiscard]] std::string path_beside(const std::string& folder, const std::string& name);

/// `folder`: where a relative path of an OBJ file starts; `name` becomes the kind of shape, or the
/// file. Throws tess::Error for what is wrong.
[[nodiscard]] tess::dn::Surface read_shape(const Node& node, const std::string& folder,
                                           std::string& name);

}  // namespace particles
