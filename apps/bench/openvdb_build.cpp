#include "apps/bench/openvdb_build.hpp"

#ifdef TESS_WITH_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#endif

namespace bench {

#ifdef TESS_WITH_OPENVDB
std::optional<std::size_t> openvdb_build(const tess::dn::Surface& surface,
                                         const tess::dn::Grid& grid,
                                         double half_width) {
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  for (const tess::dn::Vec3 p : surface.vertices)
    points.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
  std::vector<openvdb::Vec3I> triangles;
  for (const auto& t : surface.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const auto transform = openvdb::math::Transform::createLinearTransform(grid.cell);
  const auto made = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
      *transform, points, triangles, static_cast<float>(half_width));
  return static_cast<std::size_t>(made->activeVoxelCount());
}
#else
std::optional<std::size_t> openvdb_build(const tess::dn::Surface& /*surface*/,
                                         const tess::dn::Grid& /*grid*/,
                                         double /*half_width*/) {
  return std::nullopt;
}
#endif

}  // namespace bench
