#include "apps/particles/output/files.hpp"

#include "apps/kit/output/write_file.hpp"
#include "apps/particles/study/study.hpp"
#include "collide/dn_field/field_file.hpp"

#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>
#include <system_error>
#include <vector>

namespace particles {
namespace {
namespace fs = std::filesystem;

std::string field_file(std::size_t object) {
  return fmt::format("field_{}.dnf", object);
}

/// The file of the snapshot after so many steps, in the folder "trajectories".
std::string snapshot_file(std::int32_t step) {
  return fmt::format("step_{:09}.vtp", step);
}
constexpr std::string_view snapshot_prefix = "step_";
bool is_named_as_snapshot(const std::string& file) {
  return file.starts_with(snapshot_prefix) && file.ends_with(".vtp");
}
/// True if the run writes a snapshot of this name.
bool writes_snapshot(const Scene& scene, const std::string& file) {
  if (!is_named_as_snapshot(file)) return false;
  std::int32_t step = -1;
  (void)std::from_chars(file.data() + snapshot_prefix.size(), file.data() + file.size(), step);
  return file == snapshot_file(step) && traces(scene, step);
}

/// What is written to the folder of --out, without the snapshots, which are too many for a list.
std::vector<std::string> files_of(const Scene& scene, const Options& options) {
  std::vector<std::string> files;
  if (options.study)
    for (const std::string& picture : study_pictures())
      files.insert(files.end(), {picture, kit::data_path(picture)});
  if (options.study) return files;
  const Outputs& outputs = scene.outputs;
  for (std::size_t i = 0; outputs.fields && i < scene.objects.size(); ++i)
    files.push_back(field_file(i));
  if (outputs.slice) files.emplace_back("field.svg");
  if (outputs.trajectories > 0) files.insert(files.end(), {"paths.svg", "trajectories.pvd"});
  return files;
}

/// Writes FOLDER/trajectories.pvd, which lists the snapshots by time, and
/// FOLDER/trajectories/step_N.vtp.
void write_series(const fs::path& folder, const std::vector<Snapshot>& snapshots, double dt) {
  std::string series =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const Snapshot& snapshot : snapshots) {
    const std::string name = snapshot_file(snapshot.step);
    kit::write_file((folder / "trajectories" / name).string(), vtp(snapshot));
    series += fmt::format("<DataSet timestep=\"{}\" file=\"trajectories/{}\"/>\n",
                          snapshot.step * dt, name);
  }
  kit::write_file((folder / "trajectories.pvd").string(), series + "</Collection>\n</VTKFile>\n");
}

}  // namespace

std::string vtp(const Snapshot& snapshot) {
  const std::size_t n = snapshot.samples.size();
  std::string ids, positions, velocities, vertices, offsets;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& [id, p, v] = snapshot.samples[i];
    ids += fmt::format("{}\n", id);
    positions += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    velocities += fmt::format("{} {} {}\n", v.x, v.y, v.z);
    vertices += fmt::format("{}\n", i);
    offsets += fmt::format("{}\n", i + 1);
  }
  const auto array = [](const char* attributes, const std::string& values) {
    return fmt::format("<DataArray {} format=\"ascii\">\n{}</DataArray>\n", attributes, values);
  };
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<PolyData>\n<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
      "<PointData Scalars=\"id\" Vectors=\"velocity\">\n{1}{2}</PointData>\n"
      "<Points>\n{3}</Points>\n<Verts>\n{4}{5}</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n",
      n, array("type=\"Int64\" Name=\"id\"", ids),
      array("type=\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\"", velocities),
      array("type=\"Float64\" NumberOfComponents=\"3\"", positions),
      array("type=\"Int64\" Name=\"connectivity\"", vertices),
      array("type=\"Int64\" Name=\"offsets\"", offsets));
}

void prepare_files(const Scene& scene, const Options& options, kit::FileNames& names) {
  names.reads("SCENE", options.scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    names.reads(fmt::format("objects[{}].field", i), scene.objects[i].field);
    names.reads(fmt::format("objects[{}].shape.file", i), scene.objects[i].file);
  }
  if (options.out.empty()) return;
  const fs::path in(options.out);
  const std::string what = "--out " + options.out;
  // Names in the folder differ from each other: each is compared with those outside only.
  const auto check = [&](const fs::path& file) {
    kit::FileNames(names).writes(what + ":", (in / file).string());
  };
  for (const std::string& file : files_of(scene, options)) {
    check(file);
    kit::require_writable(what, (in / file).string());
  }
  if (options.study || scene.outputs.trajectories == 0) return;
  for (const kit::FileNames::Taken& other : names.taken()) {
    const std::string name = fs::path(other.path).filename().string();
    if (is_named_as_snapshot(name)) check(fs::path("trajectories") / name);
  }
  kit::make_folder(what, in / "trajectories");
  // Only a snapshot whose name is taken can fail in a folder that can be written.
  std::error_code unreadable;
  for (const fs::directory_entry& taken : fs::directory_iterator(in / "trajectories", unreadable)) {
    const std::string name = taken.path().filename().string();
    if (writes_snapshot(scene, name)) kit::require_writable(what, taken.path().string());
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
    kit::write_file((in / "field.svg").string(), slice_svg(field, outputs.axes.front(), slice->at));
  }
  if (result.trajectories.empty()) return;
  write_series(in, result.trajectories, stage.scene.dt);
  kit::write_file((in / "paths.svg").string(), paths_svg(stage.scene, result.trajectories));
}

}  // namespace particles
