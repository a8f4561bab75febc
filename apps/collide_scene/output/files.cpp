#include "apps/collide_scene/output/files.hpp"

#include "apps/collide_scene/output/picture.hpp"
#include "apps/collide_scene/output/vtp.hpp"
#include "apps/kit/write_file.hpp"

#include <filesystem>

namespace collide_scene {

void prepare_files(const Options& options) {
  kit::require_writable("--json", options.json);
  if (options.out.empty()) return;
  kit::make_folder("--out " + options.out, std::filesystem::path(options.out).parent_path());
  for (const char* file : {".svg", "_hits.vtp", "_pairs.vtp"})
    kit::require_writable("--out", options.out + file);
  if (!options.study) return;
  for (const char* file :
       {"_study.csv", "_study_time.svg", "_study_entries.svg", "_study_error.svg"})
    kit::require_writable("--out", options.out + file);
}

void write_files(const std::string& prefix, const Scene& scene, std::span<const ScenePair> pairs) {
  std::vector<std::uint32_t> n_hits(scene.n_objects(), 0);
  for (const ScenePair& pair : pairs) {
    ++n_hits[pair.first];
    ++n_hits[pair.second];
  }
  kit::write_file(prefix + "_hits.vtp", hits_vtp(scene, n_hits));
  kit::write_file(prefix + "_pairs.vtp", pairs_vtp(scene, pairs));
  kit::write_file(prefix + ".svg", picture(scene, n_hits));
}

}  // namespace collide_scene
