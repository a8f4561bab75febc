#include "apps/collide_scene/output/files.hpp"

#include "apps/kit/output/write_file.hpp"

#include <filesystem>

namespace collide_scene {

void prepare_files(const std::string& prefix, const std::vector<std::string>& endings,
                   kit::FileNames& files) {
  if (prefix.empty()) return;
  kit::make_folder("--out " + prefix, std::filesystem::path(prefix).parent_path());
  for (const std::string& ending : endings) {
    kit::require_writable("--out", prefix + ending);
    files.writes("--out", prefix + ending);
  }
}

std::vector<std::string> endings() {
  return {".svg", "_owners.svg", "_hits.vtp", "_pairs.vtp"};
}

void write_files(const std::string& prefix, const Scene& scene, const RunResult& result,
                 std::int32_t n_owners) {
  std::vector<std::uint32_t> n_hits(scene.n_objects(), 0);
  for (const ScenePair& pair : result.pairs) {
    ++n_hits[pair.first];
    ++n_hits[pair.second];
  }
  kit::write_file(prefix + "_hits.vtp", hits_vtp(scene, n_hits));
  kit::write_file(prefix + "_pairs.vtp", pairs_vtp(scene, result.pairs));
  kit::write_file(prefix + ".svg", picture(scene, n_hits));
  kit::write_file(prefix + "_owners.svg",
                  picture_of_owners(scene, n_owners, result.grid.counts.voxel_size));
}

}  // namespace collide_scene
