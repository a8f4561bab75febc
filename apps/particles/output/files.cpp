#include "apps/particles/output/files.hpp"

#include "apps/particles/output/picture.hpp"
#include "apps/particles/output/vtp.hpp"
#include "apps/plot/write_file.hpp"
#include "collide/dn_field/field_file.hpp"
#include "runtime/core/error.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <string_view>

namespace particles {
namespace {
namespace fs = std::filesystem;

std::string field_file(std::size_t object) {
  return fmt::format("field_{}.dnf", object);
}

void require_writable_in(const std::string& folder, const fs::path& file) {
  if (const std::string why = plot::hindrance(file); !why.empty())
    tess::fail(tess::ErrorCode::environment, "--out ", folder, ": ", file.string(),
               " cannot be written: ", why, "; move that away, or give another folder");
}

/// Checks the files whose names begin so: this run writes them again.
void require_writable_in(const std::string& folder, const fs::path& in, std::string_view begin) {
  std::error_code error;
  for (fs::directory_iterator at(in, error), end; !error && at != end; at.increment(error))
    if (at->path().filename().string().starts_with(begin)) require_writable_in(folder, at->path());
}

}  // namespace

void prepare_files(const Scene& scene, const Options& options) {
  plot::make_folder("--out " + options.out, options.out);
  plot::require_writable("--json", options.json);
  if (options.out.empty()) return;
  const fs::path in(options.out);
  const auto require = [&](const std::string& file) {
    require_writable_in(options.out, in / file);
  };
  for (std::size_t i = 0; scene.outputs.fields && i < scene.objects.size(); ++i)
    require(field_file(i));
  if (scene.outputs.slice) require("field.svg");
  if (scene.outputs.trajectories > 0) {
    require("paths.svg");
    require("trajectories.pvd");
    plot::make_folder("--out " + options.out, in / "trajectories");
    require_writable_in(options.out, in / "trajectories", "step_");
  }
  if (options.study) require_writable_in(options.out, in, "study");
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
