// The files of --out and --json, and whether they can be written: checked before the run begins.
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"

#include <span>
#include <string>

namespace collide_scene {

/// Makes the folder of --out, and checks each file that this run will write. Throws tess::Error
/// (environment) that names the option, the path and the remedy.
void prepare_files(const Options& options);

/// PREFIX.svg, PREFIX_hits.vtp, PREFIX_pairs.vtp. `pairs`: of the scene as it is.
void write_files(const std::string& prefix, const Scene& scene, std::span<const ScenePair> pairs);

}  // namespace collide_scene
