#include "apps/particles/output/vtp.hpp"

#include "apps/plot/write_file.hpp"

#include <filesystem>
#include <fmt/core.h>

namespace particles {
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

void write_series(const std::string& folder, const std::vector<Snapshot>& snapshots, double dt) {
  const std::filesystem::path pieces = std::filesystem::path(folder) / "trajectories";
  plot::make_folder("--out " + folder, pieces);
  std::string series =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const Snapshot& snapshot : snapshots) {
    const std::string name = fmt::format("step_{:09}.vtp", snapshot.step);
    plot::write_file((pieces / name).string(), vtp(snapshot));
    series += fmt::format("<DataSet timestep=\"{}\" file=\"trajectories/{}\"/>\n",
                          snapshot.step * dt, name);
  }
  plot::write_file((std::filesystem::path(folder) / "trajectories.pvd").string(),
                   series + "</Collection>\n</VTKFile>\n");
}

}  // namespace particles
