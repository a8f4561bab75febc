// An object of a scene file: its shape, how it stands and moves, and its field.
#pragma once

#include "apps/particles/json_reader.hpp"
#include "apps/particles/scene.hpp"

#include <string>

namespace particles {

/// What fields that are chosen by speed have to cover.
struct StepDemand {
  double dt = 0;
  bool swept = false;  ///< impacts are followed along the step, at any speed
};

/// `folder`: where relative paths of files start. Throws tess::Error for what is wrong.
[[nodiscard]] SceneObject read_object(const Node& node,
                                      const std::string& folder,
                                      const StepDemand& demand);

}  // namespace particles
