#include "apps/particles/output/vtp.hpp"

#include "apps/plot/write_file.hpp"
#include "runtime/core/error.hpp"

#include <filesystem>
#include <fmt/core.h>

namespace particles {
namespace {

std::string vectors(const Snapshot& snapshot, tess::dn::Vec3 Sample::*of) {
  std::string out;
  for (const Sample& sample : snapshot.samples) {
    const tess::dn::Vec3 v = sample.*of;
    out += fmt::format("{} {} {}\n", v.x, v.y, v.z);
  }
  return out;
}

}  // namespace

std::string vtp(const Snapshot& snapshot) {
  const std::size_t n = snapshot.samples.size();
  std::string ids, vertices, offsets;
  for (std::size_t i = 0; i < n; ++i) {
    ids += fmt::format("{}\n", snapshot.samples[i].id);
    vertices += fmt::format("{}\n", i);
    offsets += fmt::format("{}\n", i + 1);
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<PolyData>\n<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
      "<PointData Scalars=\"id\" Vectors=\"velocity\">\n"
      "<DataArray type=\"Int64\" Name=\"id\" format=\"ascii\">\n{1}</DataArray>\n"
      "<DataArray type=\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\" "
      "format=\"ascii\">\n{2}</DataArray>\n</PointData>\n"
      "<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">\n{3}</DataArray>\n</Points>\n"
      "<Verts>\n<DataArray type=\"Int64\" Name=\"connectivity\" "
      "format=\"ascii\">\n{4}</DataArray>\n"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n{5}</DataArray>\n</Verts>\n"
      "</Piece>\n</PolyData>\n</VTKFile>\n",
      n, ids, vectors(snapshot, &Sample::velocity), vectors(snapshot, &Sample::position), vertices,
      offsets);
}

void write_series(const std::string& folder, const std::vector<Snapshot>& snapshots, double dt) {
  const std::filesystem::path pieces = std::filesystem::path(folder) / "trajectories";
  std::error_code error;
  std::filesystem::create_directories(pieces, error);
  if (error)
    tess::fail(tess::ErrorCode::environment, "--out ", pieces.string(),
               ": cannot be made: ", error.message());
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
