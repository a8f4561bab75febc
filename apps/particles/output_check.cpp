#include "apps/particles/output_check.hpp"

#include "runtime/error.hpp"

#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace particles {
namespace {
namespace fs = std::filesystem;

/// What access() says of it; empty where it allows `how`.
std::string denial(const fs::path& path, int how) {
  if (::access(path.c_str(), how) == 0) return {};
  return std::generic_category().message(errno);
}

/// Why a file cannot be written; empty where it can, as far as can be told without writing it.
std::string hindrance(const fs::path& file) {
  std::error_code error;
  const fs::file_status there = fs::status(file, error);
  if (fs::is_directory(there)) return "is a directory";
  if (fs::exists(there)) return denial(file, W_OK);
  if (there.type() == fs::file_type::none) return error.message();
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::exists(folder, error)) return "its folder " + folder.string() + " does not exist";
  if (!fs::is_directory(folder, error)) return folder.string() + " is not a directory";
  if (!file.has_filename()) return "names no file";
  return denial(folder, W_OK | X_OK);
}

void require_in_folder(const std::string& folder, const fs::path& file) {
  if (const std::string why = hindrance(file); !why.empty())
    tess::fail(tess::ErrorCode::environment,
               "--out ",
               folder,
               ": ",
               file.string(),
               " cannot be written: ",
               why,
               "; move that away, or give another folder");
}

/// Files that are there already and whose names begin so will be written again.
void require_begun(const std::string& folder, const fs::path& in, std::string_view begin) {
  std::error_code error;
  for (fs::directory_iterator at(in, error), end; !error && at != end; at.increment(error))
    if (at->path().filename().string().starts_with(begin)) require_in_folder(folder, at->path());
}

void make_folder(const std::string& option, const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  std::string why = error ? error.message() : denial(path, W_OK | X_OK);
  if (!why.empty())
    tess::fail(tess::ErrorCode::environment,
               "--out ",
               option,
               ": ",
               path.string(),
               " cannot be made a folder to write to: ",
               why,
               "; give another");
}

void prepare_folder(const Scene& scene, const DriverOptions& options) {
  const std::string& folder = options.out;
  const fs::path in(folder);
  make_folder(folder, in);
  std::vector<std::string> names;
  if (scene.outputs.fields)
    for (std::size_t i = 0; i < scene.objects.size(); ++i) names.push_back(field_file_name(i));
  if (scene.outputs.slice) names.push_back("field.svg");
  if (scene.outputs.trajectories > 0) {
    names.insert(names.end(), {"paths.svg", "trajectories.pvd"});
    make_folder(folder, in / "trajectories");
    require_begun(folder, in / "trajectories", "step_");
  }
  for (const std::string& name : names) require_in_folder(folder, in / name);
  if (options.study) require_begun(folder, in, "study");
}

}  // namespace

void prepare_outputs(const Scene& scene, const DriverOptions& options) {
  if (!options.out.empty()) prepare_folder(scene, options);
  if (options.json.empty()) return;
  if (const std::string why = hindrance(options.json); !why.empty())
    tess::fail(tess::ErrorCode::environment,
               "--json ",
               options.json,
               ": cannot be written: ",
               why,
               "; give the path of a file in a folder that can be written");
}

}  // namespace particles
