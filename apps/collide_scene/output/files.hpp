// The files of --out, and whether they can be written: checked before the run begins.
#pragma once

#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"
#include "apps/kit/output/file_names.hpp"

#include <span>
#include <string>
#include <vector>

namespace collide_scene {

/// Makes the folder of --out, and checks the files PREFIX + ending that this run will write. Throws
/// tess::Error that names the option, the path and the remedy.
void prepare_files(const std::string& prefix, const std::vector<std::string>& endings,
                   kit::FileNames& files);

/// Gives the endings of the files of a run.
[[nodiscard]] std::vector<std::string> endings();

/// The scene as an SVG, seen from above and aside: models in pale colours, what collides from
/// yellow to violet by the rank of its number of hits. Only what is seen is in it: at most some ten thousand
/// triangles as they are, more as rows of pixels. n_hits: one per object.
[[nodiscard]] std::string picture(const Scene& scene, std::span<const std::uint32_t> n_hits);

/// The same scene with a colour per owner, of consecutive objects each, and the voxels of this edge
/// on its ground.
[[nodiscard]] std::string picture_of_owners(const Scene& scene, std::int32_t n_owners,
                                            double voxel_size);

// Results for ParaView, as the text of VTP files with raw binary data behind it.

/// The triangles (of boxes: their faces, as quadrilaterals) with the number of hits of the object,
/// its model and its position in the scene. n_hits: one per object.
[[nodiscard]] std::string hits_vtp(const Scene& scene, std::span<const std::uint32_t> n_hits);

/// A segment per pair, between the centres of the boxes of the two, with the positions of both.
[[nodiscard]] std::string pairs_vtp(const Scene& scene, std::span<const ScenePair> pairs);

/// PREFIX.svg, PREFIX_owners.svg, PREFIX_hits.vtp, PREFIX_pairs.vtp. `result`: of the scene as it is.
void write_files(const std::string& prefix, const Scene& scene, const RunResult& result,
                 std::int32_t n_owners);

}  // namespace collide_scene
