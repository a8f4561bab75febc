// The objects of a scene file: shapes that are built in, or triangles from an OBJ file.
#pragma once

#include "apps/particles/json_reader.hpp"
#include "apps/particles/scene.hpp"

#include <string>

namespace particles {

/// `folder`: where a relative path of an OBJ file starts. `dt`: the time step, for fields that are
/// chosen by speed. Throws tess::Error for what is wrong.
[[nodiscard]] SceneObject read_object(const Node& node, const std::string& folder, double dt);

}  // namespace particles
