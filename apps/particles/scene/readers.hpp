// The parts of a scene file. All throw tess::Error for what is wrong.
#pragma once

#include "apps/particles/scene/json.hpp"
#include "apps/particles/scene/scene.hpp"

#include <string>

namespace particles {

/// The path of a file that a scene in `folder` names.
[[nodiscard]] std::string path_beside(const std::string& folder, const std::string& name);

/// A built-in shape, or triangles from an OBJ file.
[[nodiscard]] tess::dn::Surface read_shape(const Node& node, const std::string& folder);

/// Its shape, how it stands and moves, and its field, of which the step and the rules say what it
/// has to cover.
[[nodiscard]] SceneObject read_object(const Node& node, const std::string& folder, double dt,
                                      const tess::dn::Rules& rules);

}  // namespace particles
