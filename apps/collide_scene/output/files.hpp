// The files of --out, and whether they can be written: checked before the run begins.
#pragma once

#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"
#include "apps/kit/file_names.hpp"

#include <span>
#include <string>
#include <vector>

namespace collide_scene {

/// Makes the folder of --out, and checks the files PREFIX + ending that this run will write. Throws
/// tess::Error that names the option, the path and the remedy.
void prepare_files(const std::string& prefix, const std::vector<std::string>& endings,
                   kit::FileNames& files);

/// Of the files of a run.
[[nodiscard]] std::vector<std::string> endings();

/// PREFIX.svg, PREFIX_hits.vtp, PREFIX_pairs.vtp. `pairs`: of the scene as it is.
void write_files(const std::string& prefix, const Scene& scene, std::span<const ScenePair> pairs);

}  // namespace collide_scene
