#include "apps/bench/dn_field/openvdb_field.hpp"

#ifdef TESS_WITH_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>
#endif

namespace bench {

#ifdef TESS_WITH_OPENVDB
struct OpenVdbField::Library {
  openvdb::FloatGrid::Ptr grid;
};

std::optional<OpenVdbField> OpenVdbField::build(const tess::dn::Surface& surface,
                                                const tess::dn::Grid& grid, double half_width) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  for (const tess::dn::Vec3 p : surface.vertices)
    points.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
  std::vector<openvdb::Vec3I> triangles;
  for (const auto& t : surface.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const auto transform = openvdb::math::Transform::createLinearTransform(grid.cell);
  return OpenVdbField(
      std::make_shared<const Library>(Library{openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
          *transform, points, triangles, static_cast<float>(half_width))}));
}

std::size_t OpenVdbField::n_voxels() const {
  return static_cast<std::size_t>(library_->grid->activeVoxelCount());
}

namespace {
template <class Sampler>
void sample(const openvdb::FloatGrid& grid, const tess::dn::Points& points,
            std::span<float> distance) {
  const auto accessor = grid.getConstAccessor();
  const openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, Sampler> sampler(
      accessor, grid.transform());
  for (std::size_t p = 0; p < distance.size(); ++p)
    distance[p] = sampler.wsSample(openvdb::Vec3R(points.x[p], points.y[p], points.z[p]));
}
}  // namespace

void OpenVdbField::look_up(tess::dn::LookUp kind, const tess::dn::Points& points,
                           std::span<float> distance) const {
  if (kind == tess::dn::LookUp::trilinear)
    sample<openvdb::tools::BoxSampler>(*library_->grid, points, distance);
  else
    sample<openvdb::tools::PointSampler>(*library_->grid, points, distance);
}
#else
struct OpenVdbField::Library {};

std::optional<OpenVdbField> OpenVdbField::build(const tess::dn::Surface& /*surface*/,
                                                const tess::dn::Grid& /*grid*/,
                                                double /*half_width*/) {
  return std::nullopt;
}
std::size_t OpenVdbField::n_voxels() const {
  return 0;
}
void OpenVdbField::look_up(tess::dn::LookUp /*kind*/, const tess::dn::Points& /*points*/,
                           std::span<float> /*distance*/) const {}
#endif

}  // namespace bench
