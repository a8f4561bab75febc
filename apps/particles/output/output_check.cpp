#include "apps/particles/output/output_check.hpp"

#include "apps/plot/write_file.hpp"
#include "runtime/core/error.hpp"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

namespace particles {
namespace {
namespace fs = std::filesystem;

void require_in_folder(const std::string& folder, const fs::path& file) {
  if (const std::string why = plot::hindrance(file); !why.empty())
    tess::fail(tess::ErrorCode::environment, "--out ", folder, ": ", file.string(),
               " cannot be written: ", why, "; move that away, or give another folder");
}

/// Files that are there already and whose names begin so will be written again.
void require_begun(const std::string& folder, const fs::path& in, std::string_view begin) {
  std::error_code error;
  for (fs::directory_iterator at(in, error), end; !error && at != end; at.increment(error))
    if (at->path().filename().string().starts_with(begin)) require_in_folder(folder, at->path());
}

void prepare_folder(const Scene& scene, const Options& options) {
  const std::string& folder = options.out;
  const fs::path in(folder);
  plot::make_folder("--out " + folder, in);
  std::vector<std::string> names;
  if (scene.outputs.fields)
    for (std::size_t i = 0; i < scene.objects.size(); ++i) names.push_back(field_file_name(i));
  if (scene.outputs.slice) names.push_back("field.svg");
  if (scene.outputs.trajectories > 0) {
    names.insert(names.end(), {"paths.svg", "trajectories.pvd"});
    plot::make_folder("--out " + folder, in / "trajectories");
    require_begun(folder, in / "trajectories", "step_");
  }
  for (const std::string& name : names) require_in_folder(folder, in / name);
  if (options.study) require_begun(folder, in, "study");
}

}  // namespace

void prepare_outputs(const Scene& scene, const Options& options) {
  if (!options.out.empty()) prepare_folder(scene, options);
  plot::require_writable("--json", options.json);
}

}  // namespace particles
