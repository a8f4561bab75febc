// An object of a scene file: its shape, how it stands and moves, and its field.
#pragma once

#include "apps/particles/scene/json_reader.hpp"
#include "apps/particles/scene/scene.hpp"

#include <string>

namespace particles {

/// `folder`: where relative paths of files start. The step and the rules say what a field has to
/// do. Throws tess::Error for what is wrong.
[[nodiscard]] SceneObject read_object(const Node& node, const std::string& folder, double dt,
                                      const tess::dn::Rules& rules);

}  // namespace particles
