// From the arguments of the command line to one scene: files of surfaces and scenes made by rule.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

#include <span>
#include <string>

namespace collide_scene {

/// One argument: as the file or the rule gives it. Several: all their objects, with the models
/// numbered anew; an argument whose objects have no models is one model. A file is one model.
/// Throws tess::Error that names the argument, also if boxes and triangles would be mixed.
[[nodiscard]] Scene load(std::span<const std::string> inputs, std::uint64_t seed);

/// 1 + the greatest model number; 0 for a scene without models.
[[nodiscard]] std::uint32_t n_models(const Scene& scene);

/// For --help: a line per kind of scene.
[[nodiscard]] std::string scenes_help();

}  // namespace collide_scene
