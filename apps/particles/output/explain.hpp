// What a run of a scene uses and builds, what for, and what it leaves out.
#pragma once

#include "apps/particles/options.hpp"
#include "apps/particles/scene/scene.hpp"

#include <string>

namespace particles {

/// For --explain.
[[nodiscard]] std::string explanation(const Scene& scene, const Options& options);

}  // namespace particles
