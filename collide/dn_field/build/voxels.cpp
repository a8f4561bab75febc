#include "collide/dn_field/build/voxels.hpp"

#include "collide/dn_field/prepared_triangle.hpp"

#include <algorithm>
#include <limits>

namespace tess::dn {
namespace {
constexpr double tie = 1e-9;  // of a cell: a face between two layers of voxels meets both
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();  // of the coordinates

/// First and last, inclusive.
std::pair<int, int> voxels_near(double low, double high, double origin, double cell, int n) {
  return {static_cast<int>(std::clamp(std::floor((low - origin) / cell), 0.0, 1.0 * n)),
          static_cast<int>(std::clamp(std::ceil((high - origin) / cell), -1.0, n - 1.0))};
}

double largest(const Bounds& box) {
  double most = 0;
  for (const Vec3 p : {box.low, box.high})
    most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return most;
}

}  // namespace

std::vector<SurfaceVoxel> surface_voxels(const Surface& surface, const Grid& grid) {
  std::vector<std::uint32_t> hits(grid.size(), 0);
  std::vector<std::pair<std::size_t, Vec3>> found;
  Bounds all = bounds(surface);
  all.extend(grid.origin);
  const double slack = tie * grid.cell + rounding * largest(all);
  for (std::size_t number = 0; number < surface.triangles.size(); ++number) {
    const auto corners = surface.corners(number);
    const PreparedTriangle t = prepare(corners);
    Bounds box;
    for (const Vec3 p : corners) box.extend(p);
    const double half = 0.5 * grid.cell;
    const double span = std::abs(t.normal.x) + std::abs(t.normal.y) + std::abs(t.normal.z);
    const double reach = half * std::max(1.0, span) + slack;
    const auto [i0, i1] = voxels_near(box.low.x, box.high.x, grid.origin.x, grid.cell, grid.n[0]);
    const auto [j0, j1] = voxels_near(box.low.y, box.high.y, grid.origin.y, grid.cell, grid.n[1]);
    const auto [k0, k1] = voxels_near(box.low.z, box.high.z, grid.origin.z, grid.cell, grid.n[2]);
    for (int k = k0; k <= k1; ++k)
      for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
          const Vec3 p = grid.centre(i, j, k);
          if (distance2(t, p.x, p.y, p.z) > reach * reach) continue;
          found.emplace_back(grid.index(i, j, k), t.normal);
          ++hits[found.back().first];
        }
  }
  // In the order of the grid and then of the triangles, so that sums are reproducible.
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SurfaceVoxel> voxels;
  for (const auto& [at, normal] : found) {
    if (voxels.empty() || voxels.back().at != at) voxels.push_back({at, {}});
    voxels.back().normal += 1.0 / hits[at] * normal;
  }
  return voxels;
}

}  // namespace tess::dn
