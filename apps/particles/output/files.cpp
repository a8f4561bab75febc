#include "apps/particles/output/files.hpp"

#include "apps/particles/output/picture.hpp"
#include "apps/particles/output/vtp.hpp"
#include "apps/plot/write_file.hpp"
#include "collide/dn_field/field_file.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace particles {
namespace {
namespace fs = std::filesystem;

std::string field_file(std::size_t object) {
  return fmt::format("field_{}.dnf", object);
}

}  // namespace

void prepare_files(const Scene& scene, const Options& options) {
  plot::make_folder("--out " + options.out, options.out);
  plot::require_writable("--json", options.json);
  if (options.out.empty()) return;
  const fs::path in(options.out);
  const auto require = [&](const char* file) {
    plot::require_writable("--out " + options.out, (in / file).string());
  };
  if (scene.outputs.slice) require("field.svg");
  if (scene.outputs.trajectories > 0) {
    require("paths.svg");
    plot::make_folder("--out " + options.out, in / "trajectories");
  }
}

void write_files(const std::string& folder, const Stage& stage, const RunResult& result) {
  using namespace tess::dn;
  const Outputs& outputs = stage.scene.outputs;
  const fs::path in(folder);
  for (std::size_t i = 0; outputs.fields && i < stage.fields.size(); ++i)
    save_field(stage.fields[i].field(), (in / field_file(i)).string());
  if (const auto& slice = outputs.slice) {
    const Field& field = stage.fields[slice->object].field();
    plot::write_file((in / "field.svg").string(),
                     slice_svg(field.planes != nullptr ? expanded(field) : field,
                               outputs.axes.front(), slice->at));
  }
  if (result.trajectories.empty()) return;
  write_series(folder, result.trajectories, stage.scene.dt);
  plot::write_file((in / "paths.svg").string(), paths_svg(stage.scene, result.trajectories));
}

}  // namespace particles
